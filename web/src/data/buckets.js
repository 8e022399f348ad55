// A signal over a span of time as few points as a picture can show: per bucket its lowest and highest value, in the
// order they came. Several signals share the buckets, so their points stand at the same times.
export function bucket_times(from, to, buckets) {
  const times = new Float64Array(2 * buckets);
  const width = (to - from) / buckets;
  for (let i = 0; i < buckets; ++i) {
    times[2 * i] = from + (i + 0.25) * width;
    times[2 * i + 1] = from + (i + 0.75) * width;
  }
  return times;
}

export function bucket_values(signal, from, to, buckets) {
  const { topic, column } = signal;
  const result = new Array(2 * buckets).fill(null);
  const last = topic.row_at(to);
  const per_s = buckets / (to - from);
  const bucket_of = (row) => Math.min(buckets - 1, Math.max(0, Math.floor((topic.times[row] - from) * per_s)));
  let row = Math.max(0, topic.row_at(from));
  while (row <= last) {
    const bucket = bucket_of(row);
    let low = Infinity;
    let high = -Infinity;
    let low_row = row;
    let high_row = row;
    for (; row <= last && bucket_of(row) === bucket; ++row) {
      const value = topic.values[row * topic.width + column];
      if (value < low) [low, low_row] = [value, row];
      if (value > high) [high, high_row] = [value, row];
    }
    if (low > high) continue; // nothing but NaN
    result[2 * bucket] = low_row <= high_row ? low : high;
    result[2 * bucket + 1] = low_row <= high_row ? high : low;
  }
  return result;
}
