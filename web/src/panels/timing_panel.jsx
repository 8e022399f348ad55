// How punctual the run is: histograms of ticks and of what behaviors cost.
import { useMemo } from 'preact/hooks';
import { column_values, histogram, intervals_us } from '../data/histogram.js';
import { number, useSession } from '../watching.js';

function Bars({ title, unit, data, axes = 'counts, logarithmic' }) {
  if (!data) return null;
  const top = Math.log1p(Math.max(...data.counts));
  const width = 100 / data.counts.length;
  return (
    <figure class="histogram">
      <figcaption>{title}<small>{unit}</small></figcaption>
      <svg viewBox="0 0 100 36" preserveAspectRatio="none" role="img" aria-label={title}>
        {data.counts.map((count, i) => {
          const height = (34 * Math.log1p(count)) / top;
          return <rect key={i} x={i * width + 0.15} y={36 - height} width={width - 0.3} height={height} />;
        })}
      </svg>
      <p class="edges"><span>{number(data.low)}</span><span>{axes}</span><span>{number(data.high)}</span></p>
      <p class="figures">median <b>{number(data.median)}</b> 99 % <b>{number(data.p99)}</b> max <b>{number(data.max)}</b> of {data.count}</p>
    </figure>
  );
}

const samples_least = 20;

// What a live run tells: {name: {unit, limits, within, median, p99, max, count}}; the limits grow by a factor.
function on_log_axis(data) {
  const counts = data.within.map((within, i) => within - (data.within[i - 1] ?? 0));
  const first = counts.findIndex((count) => count > 0);
  if (first < 0) return data;
  const last = Math.max(first, counts.findLastIndex((count) => count > 0));
  return { ...data, counts: counts.slice(first, last + 1), low: data.limits[first - 1] ?? 0, high: data.limits[last] };
}
const LiveTiming = ({ timing }) => Object.entries(timing).map(([name, data]) => <Bars key={name} title={name} unit="µs" data={on_log_axis(data)} axes="both logarithmic" />);

export function TimingPanel({ session }) {
  useSession(session, 2);
  const rows = [...session.topics.values()].reduce((most, topic) => Math.max(most, topic.count), 0);
  const pictures = useMemo(() => {
    const found = [];
    const joints = session.topics.get('/joint') ?? [...session.topics.values()][0];
    if (joints && !session.timing) found.push({ title: 'Time between rows', unit: 'µs', data: histogram(intervals_us(joints)) });
    for (const [name, signal] of session.signals) {
      if (!/^behavior\..*\.(instructions|gc_pause_ns)$/.test(name)) continue;
      const data = histogram(column_values(signal).filter((value) => value > 0)); // of rows in which behaviors ticked
      if (data?.count >= samples_least) found.push({ title: name, unit: signal.unit, data }); // in virtual time a pause is no time
    }
    return found;
  }, [session, Math.floor(rows / 500), session.timing === null]);
  return (
    <div class="timing">
      <h3>Ticks</h3>
      <p class="sum">{number(session.value('safety.missed_ticks'))} missed, {number(session.value('engine.commands.applied'))} commands applied, {number(session.value('engine.commands.refused'))} refused</p>
      {session.timing && <LiveTiming timing={session.timing} />}
      {pictures.map((picture) => <Bars key={picture.title} {...picture} />)}
    </div>
  );
}
