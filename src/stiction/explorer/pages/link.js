// The web socket: JSON up, a JSON head and typed arrays down. Of each kind the newest answer counts.

const LARGEST = 2 ** 24; // bytes of a request, as the server takes them
const CLOSED = "the explorer was closed; start it again with: stiction explore";
const KINDS = { f4: Float32Array, f8: Float64Array, u1: Uint8Array, i1: Int8Array };

export function decode(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const arrays = {};
  for (const [name, kind, shape, offset] of head.arrays) {
    const count = shape.reduce((a, b) => a * b, 1);
    arrays[name] = new KINDS[kind](buffer, 4 + length + offset, count);
    arrays[name].shape = shape;
  }
  return { ...head, arrays };
}

export class Link {
  constructor(onState) {
    this.newest = new Map();
    this.count = 0;
    this.onState = onState;
    const address = new URL("socket", location.href.split("#")[0]);
    address.protocol = "ws:";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => onState("open");
    this.socket.onclose = () => {
      for (const each of this.newest.values()) if (!each.ended) each.failed({ error: CLOSED });
      onState(CLOSED);
    };
    this.socket.onmessage = (event) => this.receive(decode(event.data));
  }

  // Ask for something; `answered` is called with each part of the answer, unless a newer one came.
  ask(what, answered, failed = () => {}) {
    const id = ++this.count;
    const lane = `${what.do}/${what.lane ?? 0}`;
    const words = JSON.stringify({ ...what, id });
    this.newest.set(lane, { id, answered, failed });
    if (this.socket.readyState !== WebSocket.OPEN) this.receive({ do: what.do, lane: what.lane ?? 0, id, error: CLOSED });
    else if (new Blob([words]).size > LARGEST) this.receive({ do: what.do, lane: what.lane ?? 0, id, error: "this is too large for the page; on the command line: stiction run" });
    else this.socket.send(words);
    return id;
  }

  receive(answer) {
    const known = this.newest.get(`${answer.do}/${answer.lane}`);
    if (!known || known.id !== answer.id) return;
    known.ended = Boolean(answer.end || answer.faults || answer.error);
    if (answer.faults || answer.error) known.failed(answer);
    else if (!answer.end) known.answered(answer);
  }
}
