// Counts of values in equal bins; the outermost hold what lies beyond the 0.1 % on either side.
export function histogram(values, bins = 48) {
  const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
  if (sorted.length === 0) return null;
  const quantile = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  let [low, high] = [quantile(0.001), quantile(0.999)];
  if (high - low < 1e-12 * Math.max(1, Math.abs(high))) [low, high] = [low - 0.5, high + 0.5];
  const counts = new Array(bins).fill(0);
  for (const value of sorted) ++counts[Math.min(bins - 1, Math.max(0, Math.floor((bins * (value - low)) / (high - low))))];
  return { low, high, counts, median: quantile(0.5), p99: quantile(0.99), max: sorted[sorted.length - 1], count: sorted.length };
}

// Of one signal, or of the times between the rows of a topic; at most `most` of the newest.
export function column_values(signal, most = 60_000) {
  const { topic, column } = signal;
  const first = Math.max(0, topic.count - most);
  return Float64Array.from({ length: topic.count - first }, (_, i) => topic.values[(first + i) * topic.width + column]);
}

export function intervals_us(topic, most = 60_000) {
  const first = Math.max(1, topic.count - most);
  return Float64Array.from({ length: Math.max(0, topic.count - first) }, (_, i) => Math.round((topic.times[first + i] - topic.times[first + i - 1]) * 1e7) / 10);
}
