"""The server lets its own page in, and nobody else."""

import asyncio
import http.client
import json
import re
import socket
from urllib.request import urlopen

import numpy as np
import pytest
from tests.explored import an_opened, ask, page_of, serving
from tests.waiting import PATIENCE
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import stiction as st
from stiction.cli import main
from stiction.explorer import server
from stiction.explorer.answers import tables_of
from stiction.explorer.door import explore
from stiction.result.peak import largest_spring_force


@pytest.fixture(scope="module")
def explorer():
    with serving() as made:
        yield made


def get(explorer, path, **headers):
    connection = http.client.HTTPConnection(server.HOST, explorer.port)
    named = {"Host": f"{server.HOST}:{explorer.port}"} | headers
    connection.putrequest("GET", path, skip_host=True)
    for name, value in named.items():
        if value is not None:
            connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer, body


def test_its_own_page_is_served_and_nothing_from_elsewhere(explorer):
    answer, body = get(explorer, f"/{explorer.token}/")
    assert answer.status == 200
    assert b"<title>stiction explorer" in body
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy
    assert answer.headers["Referrer-Policy"] == "no-referrer"  # the address holds the token
    assert answer.headers["Cache-Control"] == "no-store"
    for name in ("main.js", "style.css", "icon.svg"):
        assert get(explorer, f"/{explorer.token}/{name}")[0].status == 200


def test_no_file_of_the_page_names_another_place():
    for each in server.PAGES.iterdir():
        text = each.read_text("utf-8").replace("http://www.w3.org/2000/svg", "")
        assert "http:" not in text, each.name
        assert "https:" not in text, each.name
        assert "@import" not in text, each.name


@pytest.mark.parametrize("path", ["/", "/main.js", "/wrong/main.js", "/{token}x/", "//{token}"])
def test_without_the_token_there_is_nothing(explorer, path):
    answer, body = get(explorer, path.format(token=explorer.token))
    assert answer.status == 404
    assert explorer.token.encode() not in body


@pytest.mark.parametrize("name", ["../server.py", "..%2fserver.py", "pages", "%2e%2e/door.py"])
def test_no_other_file_is_served(explorer, name):
    assert get(explorer, f"/{explorer.token}/{name}")[0].status == 404


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "localhost:80", None])
def test_another_host_is_refused(explorer, host):
    """A name that an attacker points at this machine does not reach the page (DNS rebinding)."""
    answer, body = get(explorer, f"/{explorer.token}/", Host=host)
    assert answer.status == 403
    assert b"<title>" not in body


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1"])
def test_another_origin_is_refused(explorer, origin):
    assert get(explorer, f"/{explorer.token}/", Origin=origin)[0].status == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "null", None])
def test_no_other_page_opens_the_web_socket(explorer, origin):
    address = explorer.address.replace("http:", "ws:") + "socket"
    with pytest.raises(InvalidStatus, match="403"):
        connect(address, origin=origin)
    with pytest.raises(InvalidStatus, match="404"):
        connect(address.replace(explorer.token, "guess"), origin=explorer.origin)


def test_it_listens_on_this_machine_only(explorer):
    addresses = {each.getsockname()[0] for each in explorer._server.sockets}
    assert addresses == {"127.0.0.1"}
    assert all(each.family == socket.AF_INET for each in explorer._server.sockets)


def test_each_start_has_a_token_of_its_own(explorer):
    with serving() as other:
        assert other.token != explorer.token
        assert len(other.token) >= 24  # 18 random bytes


def test_two_pages_do_not_disturb_each_other(explorer):
    description = an_opened().description
    other = description._replace(slider=description.slider.replace(phi="5 deg"))
    with page_of(explorer) as one, page_of(explorer) as two:
        for page, what in ((one, description), (two, other)):
            page.send(json.dumps({"do": "run", "id": 7, "tables": tables_of(what)}))
        for page, what in ((two, other), (one, description)):
            head, _ = ask(page, 8, do="run", tables=tables_of(what))[-1]
            assert head["scene"]["phi"] == what.slider.phi


def test_what_is_not_a_request_is_ignored(explorer):
    with page_of(explorer) as page:
        for text in ("", "[1]", "{}", '{"do": "shell", "id": 1}', '{"do": "run"}', "[" * 5000):
            page.send(text)
        for values in ('"do": {}, "id": 1', '"do": [], "id": 1', '"do": "run", "id": Infinity'):
            page.send(f"{{{values}}}")
        page.send(b"\x00\xff")
        assert ask(page, 3, do="start")[0][0]["preset"] == ""


def test_it_ends_with_its_last_page(monkeypatch):
    monkeypatch.setattr(server, "PATIENCE", 0.0)
    with serving(ends=True) as explorer:
        with page_of(explorer) as page:
            ask(page, do="start")
            assert not explorer._done.is_set()
        waiting = explorer.wait()
        from tests.waiting import until

        until(explorer._done.is_set)
        waiting.close()


def test_the_page_knows_how_large_a_request_may_be():
    """It sent one that was too large, which closed the socket."""
    text = (server.PAGES / "link.js").read_text("utf-8")
    (power,) = re.findall(r"const LARGEST = 2 \*\* (\d+);", text)
    assert 2 ** int(power) == server.LARGEST_REQUEST
    assert server.PATIENCE >= 10.0  # s: one may have left the page by mistake


def test_the_numbers_are_those_of_simulate(explorer):
    description = an_opened().description
    with page_of(explorer) as page:
        head, arrays = ask(page, do="run", tables=tables_of(description))[-1]
        fine = ask(page, 2, do="fine", tables=tables_of(description), time=0.02, width=1e-3)[-1]
    run = st.simulate(description.slider, description.run.duration)
    facts = {each["name"].strip(): each["value"] for each in head["facts"]}
    assert facts["largest k_x u_x"] == largest_spring_force(run.samples, run.slider.k_x).force
    assert facts["stick intervals"] == run.sticks.sizes["stick"]
    assert facts["time at rest"] == run.statistics.time_stuck
    assert facts["u_x at the end"] == float(run.final["u_x"])
    force = run.samples["spring_y"].astype(np.float32)
    assert arrays["spring_y"].max() >= force.max()  # no peak is lost
    assert arrays["spring_y"].min() <= force.min()
    wanted = st.simulate(description.slider, 0.02, sample_rate=0).final
    # the steps before are the same; only the last one ends elsewhere
    for name in ("u_x", "u_y", "slip_x", "friction"):
        assert fine[0]["at"][name] == pytest.approx(float(wanted[name]), rel=1e-7), name


def test_in_a_notebook_the_page_is_served_beside_the_next_cells(capsys):
    """An event loop runs there, in which no other may be run."""

    async def cell():
        explore(an_opened().description, browser=False)

    asyncio.run(cell())
    said = capsys.readouterr().out
    address = re.search(r"http://\S+", said).group()
    assert "it ends with the notebook" in said
    with urlopen(address, timeout=PATIENCE) as page:
        assert b"stiction explorer" in page.read()


def test_in_a_notebook_a_port_that_is_taken_is_told():
    async def cell(port):
        explore(an_opened().description, browser=False, port=port)

    with (
        socket.create_server(("127.0.0.1", 0)) as taken,
        pytest.raises(st.StictionError, match="in use"),
    ):
        asyncio.run(cell(taken.getsockname()[1]))


def test_a_port_in_use_is_said_to_be_and_the_remedy(capsys):
    """It was an OSError, and on the command line standard output was blamed."""
    with socket.create_server((server.HOST, 0)) as busy:
        port = busy.getsockname()[1]
        says = f"port {port} cannot be listened on: Address already in use; choose another, or 0"

        async def in_a_notebook():
            explore(port=port, browser=False)

        with pytest.raises(st.StictionError, match=says):
            explore(port=port, browser=False)
        with pytest.raises(st.StictionError, match=says):
            asyncio.run(in_a_notebook())
        with pytest.raises(SystemExit) as end:
            main(["explore", "--port", str(port), "--no-browser"])
    assert end.value.code == 2
    assert says in " ".join(capsys.readouterr().err.split())
