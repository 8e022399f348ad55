// Runs before the page's own files are there, from within index.html: connects to the run, whose first messages then wait
// for the page.
(() => {
  const wanted = new URLSearchParams(location.search);
  if (['record', 'render', 'empty'].some((key) => wanted.has(key))) return;
  const address = new URL(wanted.get('live') ?? '.', location.href);
  address.protocol = address.protocol.replace('http', 'ws');
  address.search = wanted.get('token') ? `token=${encodeURIComponent(wanted.get('token'))}` : '';
  const connect = () => {
    const socket = new WebSocket(address.href, ['foxglove.sdk.v1', 'foxglove.websocket.v1']);
    socket.binaryType = 'arraybuffer';
    socket.early = [];
    socket.onmessage = ({ data }) => socket.early.push(data);
    return socket;
  };
  globalThis.kadans_run = { first: connect(), connect };
})();
