// The numbers of a message: a CDR head of four bytes, then all fields side by side, of one type (docs/viewing.md).
export const is_single = (definition) => /^\s*float32\b/m.test(definition) && !/^\s*float64\b/m.test(definition);

export function read_numbers(bytes, single, to, at) {
  const view = new DataView(bytes.buffer, bytes.byteOffset + 4, bytes.byteLength - 4);
  const size = single ? 4 : 8;
  const count = view.byteLength / size;
  for (let i = 0; i < count; ++i) to[at + i] = single ? view.getFloat32(i * size, true) : view.getFloat64(i * size, true);
  return count;
}
