// What one transition waits for: its guard's source and, of a live run, why it is not taken now.
import { useEffect, useState } from 'preact/hooks';

const again_ms = 700;

// Asked only as long as the card is shown.
function useReason(session, behavior, number, asks) {
  const [reason, set_reason] = useState(null);
  useEffect(() => {
    if (!asks) return undefined;
    let [gone, timer] = [false, 0];
    const ask = async () => {
      const answer = await session.remote.command('why', { text: behavior.name, quiet: true });
      if (gone) return;
      set_reason(answer.done ? (answer.reasons?.find((one) => one.number === number) ?? null) : { why: answer.text });
      timer = setTimeout(ask, again_ms);
    };
    ask();
    return () => ((gone = true), clearTimeout(timer));
  }, [session, behavior, number, asks]);
  return asks ? reason : null;
}

export function TransitionCard({ session, behavior, active, transition, at }) {
  const { states } = behavior.chart;
  const waits = active.has(transition.source);
  const asks = Boolean(waits && session.live && session.following && session.remote?.writes && session.remote.verbs.has('why'));
  const reason = useReason(session, behavior, transition.number, asks);
  const { guard } = transition;
  const name = (index) => <b>{states[index].path || 'any state'}</b>;
  const alone = transition.target === null;
  // It has an entry for each of its targets.
  const targets = behavior.chart.transitions.filter((one) => one.number === transition.number && !alone).map((one) => one.target);
  const place = { top: `${Math.min(at.bottom + 6, innerHeight - 190)}px`, left: `${Math.max(8, Math.min(at.x, innerWidth - 428))}px` };
  return (
    <div class="transition-card" role="tooltip" style={place}>
      <p>{name(transition.source)}{targets.map((target, i) => <>{i === 0 ? ' → ' : ' and '}{name(target)}</>)}</p>
      <p>{transition.always && <i>always </i>}{transition.label} <small>{transition.line}</small></p>
      {alone && <p class="muted">The action alone: no state is left.</p>}
      {transition.internal && <p class="muted">It does not leave {states[transition.source].path}.</p>}
      {guard && <pre>{guard.text}</pre>}
      {guard && `${guard.file}:${guard.line}` !== transition.line && <small>{guard.file}:{guard.line}</small>}
      {reason && <p class={reason.free ? 'free' : 'held'}>{reason.free ? 'nothing holds it back' : reason.why}</p>}
      {reason?.saw && <p><code>{reason.saw}</code></p>}
      {!waits && <p class="muted">Its state is not active.</p>}
    </div>
  );
}
