// Draws the robot of a record alone and posts the pictures to the server that asked (kadans render): ?at=S, or ?every=S.
import { Show } from './robot/show.js';
import { Stage } from './robot/stage.js';

const all_marks = new Set(['contacts', 'cop', 'com', 'dcm', 'support']);

const loaded = (session) =>
  new Promise((resolve, reject) => {
    session.listen(() => {
      if (session.error) reject(new Error(session.error));
      else if (session.loading === 0) resolve();
    });
  });

function times_of(session, wanted) {
  if (!wanted.has('every')) return [Number(wanted.get('at') ?? 0)];
  const every_s = Number(wanted.get('every'));
  const count = Math.floor((session.end_s - session.start_s) / every_s + 1e-6) + 1;
  return Array.from({ length: count }, (_, i) => session.start_s + i * every_s);
}

export async function render_record(session, wanted) {
  const post = (name, body) => fetch(`frames/${name}?token=${encodeURIComponent(wanted.get('token'))}`, { method: 'POST', body });
  try {
    await loaded(session);
    if (!session.urdf) throw new Error('the record holds no robot description');
    const canvas = document.body.appendChild(document.createElement('canvas'));
    const stage = new Stage(canvas);
    stage.set_theme(wanted.get('theme') ?? 'light');
    stage.resize(Number(wanted.get('width') ?? 960), Number(wanted.get('height') ?? 720), 1);
    const show = new Show(stage);
    const times = times_of(session, wanted);
    session.seek(times[0]);
    show.take(session);
    await Promise.all([show.model, ...show.others].map((model) => model.complete));
    for (const t of times) {
      show.draw(t, all_marks);
      Object.assign(globalThis, { kadans: session, kadans_stage: stage, kadans_picture: t }); // for tests
      const picture = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
      await post(`${t.toFixed(3).padStart(9, '0')}.png`, picture);
    }
    await post('done', '');
  } catch (error) {
    await post('failed', String(error.message ?? error));
  }
}
