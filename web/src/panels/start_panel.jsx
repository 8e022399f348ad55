// What is said where the robot would be while there is none: how to open a record, what went wrong, who is waited for.
import { useEffect, useState } from 'preact/hooks';

function Waiting({ session }) {
  const [long, set_long] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => set_long(true), 1500);
    return () => clearTimeout(timer);
  }, []);
  if (!long) return <p class="muted">{session.live ? 'Connecting…' : 'Reading…'}</p>;
  if (!session.live) return <p class="muted">Reading…</p>;
  return (
    <>
      <h2>{session.status ? 'No run answers' : 'The run tells of no robot yet'}</h2>
      <p class="muted">{session.status ? 'The page goes on asking. Start one with --live, or open a record.' : ''}</p>
    </>
  );
}

export function StartPanel({ session, open }) {
  const [address, set_address] = useState('');
  const waits = session.live || session.loading > 0;
  const go = (event) => {
    event.preventDefault();
    if (address.trim()) open(new URL(address.trim(), location.href).href);
  };
  return (
    <div class="start">
      {waits && !session.error ? <Waiting session={session} /> : <h2>{session.error ? 'This record cannot be shown' : session.topics.size > 0 ? 'This record describes no robot' : 'Drop a record here'}</h2>}
      {session.error && <p class="error">{session.error}</p>}
      {!session.loading && (
        <form onSubmit={go}>
          <input type="text" inputMode="url" aria-label="Address of a record" placeholder="or its address: http://…/run.mcap" value={address} onInput={(event) => set_address(event.target.value)} />
          <button disabled={!address.trim()}>Open</button>
        </form>
      )}
    </div>
  );
}
