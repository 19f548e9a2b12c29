// Where a value on a grid is positive, and along which lines its sign changes.

// Polygons and lines in shares of the map's width and height. `values` are those in the middles of
// rows by columns of cells, linear between; up to the edges they stay what they are. Where one is
// unknown (NaN), the sign changes half-way.
export function signChange(values, rows, columns) {
  const at = (k, count) => Math.min(Math.max((k + 0.5) / count, 0), 1);
  const cell = (k, count) => Math.min(Math.max(k, 0), count - 1);
  const corner = (i, j) => ({ x: at(j, columns), y: at(i, rows), value: values[cell(i, rows) * columns + cell(j, columns)] });
  const areas = [], lines = [];
  for (let i = 0; i <= rows; i++) {
    for (let j = 0; j <= columns; j++) {
      const { area, crossings } = inside([corner(i - 1, j - 1), corner(i - 1, j), corner(i, j), corner(i, j - 1)]);
      if (area.length) areas.push(area);
      for (let k = 0; k < crossings.length; k += 2) lines.push([crossings[k], crossings[k + 1]]);
    }
  }
  return { areas, lines };
}

// The part of a square that is positive, and where its edge leaves the square's edge and comes back.
function inside(corners) {
  const area = [], crossings = [];
  corners.forEach((from, k) => {
    const to = corners[(k + 1) % 4];
    if (from.value > 0) area.push([from.x, from.y]);
    if (from.value > 0 === to.value > 0) return;
    const share = from.value / (from.value - to.value), part = share === share ? share : 0.5;
    const point = [from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)];
    area.push(point);
    crossings.push(point);
  });
  if (!(corners[0].value > 0)) crossings.push(...crossings.splice(0, 1)); // the first one leaves
  return { area, crossings };
}
