// Plots below each other over the same span of time. A signal dropped beside them gets a plot of its own.
import { useState } from 'preact/hooks';
import { Plot } from './plot.jsx';
import { dragged_signal } from './signal_list.jsx';

export const live_span_s = 10;

export function Plots({ session, plots, set_plots, theme, frames }) {
  const [window_s, set_window] = useState(null);
  const [over, set_over] = useState(false);
  const span = () => {
    if (window_s) return window_s;
    if (!session.live) return [session.start_s, session.end_s];
    const to = session.following ? session.end_s : Math.max(session.cursor_s + live_span_s / 2, session.start_s + live_span_s);
    return [Math.max(to - live_span_s, Math.min(session.start_s, to - 1)), to];
  };
  const put = (at, names) => set_plots(plots.map((other, i) => (i === at ? names : other)));
  return (
    <section
      class={over ? 'plots over' : 'plots'}
      aria-label="Plots"
      onDragOver={(event) => (event.preventDefault(), set_over(true))}
      onDragLeave={() => set_over(false)}
      onDrop={(event) => {
        event.preventDefault();
        set_over(false);
        const name = dragged_signal(event);
        if (session.signals.has(name)) set_plots([...plots, [name]]);
      }}
    >
      {plots.map((names, at) => (
        <Plot
          key={at}
          {...{ session, names, span, theme, frames }}
          zoom={set_window}
          change={(next) => put(at, next)}
          close={() => set_plots(plots.filter((_, i) => i !== at))}
        />
      ))}
      {plots.length === 0 && <p class="hint">Drag signals here to plot them, or double-click one.</p>}
    </section>
  );
}
