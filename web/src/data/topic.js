// One topic's numbers over time: a row a message, in growing arrays. Memory is bounded: a record's rows are thinned by
// two whenever they reach the limit; of a live run only the newest rows are kept.
const first_rows = 1024;

export class Topic {
  constructor(name, signals, { rows_max = 120_000, keep_newest = false } = {}) {
    this.name = name;
    this.signals = signals; // {name, unit, doc}
    this.width = signals.length;
    this.rows_max = rows_max;
    this.keep_newest = keep_newest;
    this.count = 0;
    this.stride = 1; // every n-th message is kept
    this.seen = 0;
    this.times = new Float64Array(first_rows);
    this.values = new Float32Array(first_rows * this.width);
  }

  // `values`: rows side by side, as many as times.
  append(times, values) {
    for (let i = 0; i < times.length; ++i) {
      if (this.seen++ % this.stride !== 0) continue;
      // Time that runs backwards is a run that began anew.
      if (this.count > 0 && times[i] < this.times[this.count - 1]) this.count = 0;
      if (this.count === this.rows_max) this.make_room();
      if (this.count === this.times.length) this.grow();
      this.times[this.count] = times[i];
      this.values.set(values.subarray(i * this.width, (i + 1) * this.width), this.count * this.width);
      ++this.count;
    }
  }

  grow() {
    const rows = Math.min(this.rows_max, this.times.length * 2);
    const times = new Float64Array(rows);
    times.set(this.times);
    this.times = times;
    const values = new Float32Array(rows * this.width);
    values.set(this.values);
    this.values = values;
  }

  make_room() {
    const kept = this.rows_max >> 1;
    if (this.keep_newest) {
      this.times.copyWithin(0, this.count - kept, this.count);
      this.values.copyWithin(0, (this.count - kept) * this.width, this.count * this.width);
    } else {
      for (let i = 0; i < kept; ++i) {
        this.times[i] = this.times[2 * i];
        this.values.copyWithin(i * this.width, 2 * i * this.width, (2 * i + 1) * this.width);
      }
      this.stride *= 2;
    }
    this.count = kept;
  }

  // Index of the last row at or before t; -1 before the first.
  row_at(t) {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= t) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  // NaN before the first row.
  value_at(t, column) {
    const row = this.row_at(t);
    return row < 0 ? NaN : this.values[row * this.width + column];
  }
}
