// A session from a record: the worker reads, this passes on.
import { Session } from './session.js';

// `source`: a File or an address.
export function open_record(source, name) {
  const title = name ?? (typeof source === 'string' ? decodeURIComponent(source.split('/').pop().split('?')[0]) : source.name);
  const session = new Session(title, false);
  session.loading = 0.01;
  session.facts = new Map();
  const worker = new Worker(new URL('./record_worker.js', import.meta.url), { type: 'module' });
  const end = (error) => {
    session.loading = 0;
    session.error = error;
    session.changed();
    worker.terminate();
  };
  worker.onerror = (event) => end(`reading failed: ${event.message}`);
  worker.onmessage = ({ data }) => {
    if (data.kind === 'topic') session.add_topic(data.topic, data.signals);
    else if (data.kind === 'rows') session.add_rows(data.topic, data.times, data.values);
    else if (data.kind === 'text') session.add_text(data.topic, data.t, data.bytes);
    else if (data.kind === 'facts') session.facts.set(data.name, new Map(data.facts));
    else if (data.kind === 'failed') end(data.unread ? `${title} cannot be read: ${data.why}` : `${title} is no record of Kadans, or damaged: ${data.why}`);
    else if (data.kind === 'done') {
      if (data.empty) return end(`${title} holds no signals of Kadans`);
      session.status = data.complete ? '' : 'cut short';
      end('');
    } else if (data.kind === 'progress') {
      session.loading = Math.max(0.01, data.share);
      session.changed();
    }
  };
  worker.postMessage(source);
  return session;
}
