// Opens files in a worker, and shows the page of `ahm view` for them. `window.ahm` is the transport of that page.

const element = (id) => document.getElementById(id);
const cancelled = () => new DOMException('cancelled', 'AbortError');
// Not by compileStreaming, which refuses the file if the server does not know the type of .wasm files.
const wasm = fetch('ahm.wasm').then((answer) => answer.arrayBuffer()).then((bytes) => WebAssembly.compile(bytes));

/** Requests to a session in a worker, one after the other. `fetch` has the arguments and the result of window.fetch. */
class WorkerTransport {
  constructor() {
    this.waiting = [];  // {name, body, resolve, reject}; the first one is running
  }

  /** Starts a session for files. @return the answer to the request "open" */
  open(files) {
    this.files = files;
    this.end();
    this.ready = this.start(files);
    this.ready.catch(() => {});  // the requests that wait for it report the failure
    return this.ready;
  }

  async start(files) {
    const worker = this.worker = new Worker('worker.js', {type: 'module'});
    worker.onmessage = ({data}) => this.receive(data);
    worker.onerror = (event) => this.end(new Error(event.message || 'the worker of this page cannot start'));
    worker.postMessage({wasm: await wasm});
    for (const file of files) {
      const body = await contents(file);
      if (worker !== this.worker) throw cancelled();
      await this.request('file', {body});
    }
    return this.request('open', {body: nameOf(files[0])});
  }

  async fetch(name, options) {
    await this.ready;
    return this.request(name, options);
  }

  request(name, {body, signal} = {}) {
    return new Promise((resolve, reject) => {
      const request = {name, body, resolve, reject};
      if (signal?.aborted) return this.abort(request);
      signal?.addEventListener('abort', () => this.abort(request));
      this.waiting.push(request);
      if (this.waiting.length === 1) this.send();
    });
  }

  send() {
    const [request] = this.waiting;
    if (request) this.worker.postMessage({name: request.name, body: request.body});
  }

  receive({stage, fraction, status, type, body, failed}) {
    if (stage) return this.progress?.(stage, fraction);
    const request = this.waiting.shift();
    request.resolve(new Response(body, {status, headers: {'Content-Type': type}}));
    const isOpening = request.name === 'file' || request.name === 'open';
    if (failed && !isOpening) return void this.open(this.files);
    this.send();
  }

  /** Rejects a request. A running computation continues, because a worker cannot be interrupted; the next request waits for it. */
  abort(request) {
    request.reject(cancelled());
    const at = this.waiting.indexOf(request);
    if (at > 0) this.waiting.splice(at, 1);
  }

  /** Ends the running request: starts a new worker, which reads the files again. */
  cancel() {
    return this.open(this.files);
  }

  /** Ends the worker, and rejects its requests. */
  end(error = cancelled()) {
    this.worker?.terminate();
    for (const request of this.waiting.splice(0)) request.reject(error);
  }
}

const nameOf = (file) => file.name.replace(/\.gz$/i, '');

/** Name and bytes of a file, unpacked if it is compressed. */
async function contents(file) {
  const isPacked = file.name !== nameOf(file);
  try {
    const stream = isPacked ? new Response(file.stream().pipeThrough(new DecompressionStream('gzip'))) : file;
    return [nameOf(file), new Uint8Array(await stream.arrayBuffer())];
  } catch (error) {
    throw new Error(`cannot read '${file.name}': ${isPacked ? 'it is damaged, not compressed with gzip, or too large' : error.message}`);
  }
}

const transport = window.ahm = new WorkerTransport();

function say(text, isError = false) {
  element('say').textContent = text;
  element('say').classList.toggle('error', isError);
}

/** Opens the first file that is not an image or a buffer; the others may be images and buffers that it refers to. */
async function open(list) {
  // Files of this window: those that are dropped on the viewer cannot be read after its frame is removed.
  const files = Array.from(list, (file) => new File([file], file.name));
  const at = files.findIndex((file) => !/\.(bin|mtl|png|jpe?g)$/i.test(file.name));
  if (files.length === 0) return;
  if (at > 0) files.unshift(...files.splice(at, 1));
  element('viewer')?.remove();
  element('start').hidden = true;
  say(`reading ${files[0].name} …`);
  transport.progress = (stage, fraction) => say(`${stage} ${fraction > 0 ? Math.round(100 * fraction) + ' %' : '…'}`);
  try {
    const answer = await transport.open(files), {error, warnings} = await answer.json();
    if (!answer.ok) throw new Error(error);
    say(warnings.join('; '));
    const page = Object.assign(document.createElement('iframe'), {id: 'viewer', src: 'view.html', title: 'viewer'});
    page.addEventListener('load', () => acceptFiles(page.contentWindow));
    document.body.append(page);
    page.focus();
  } catch (error) {
    if (error.name === 'AbortError') return;
    element('start').hidden = false;
    say(error.message, true);
  }
}

/** A sphere with bumps of 2 n (n - 1) + 2 vertices, as an OFF file. */
function sample(n) {
  const points = [[0, 0, 1.2]], faces = [];
  for (let i = 1; i < n; ++i)
    for (let j = 0; j < 2 * n; ++j) {
      const theta = Math.PI * i / n, phi = Math.PI * j / n;
      const r = 1 + 0.15 * Math.sin(3 * theta) * Math.cos(2 * phi) + 0.2 * Math.cos(theta);
      points.push([r * Math.sin(theta) * Math.cos(phi), r * Math.sin(theta) * Math.sin(phi), r * Math.cos(theta)]);
    }
  points.push([0, 0, -0.8]);
  const at = (i, j) => (i === 0 ? 0 : i === n ? points.length - 1 : 1 + (i - 1) * 2 * n + j % (2 * n));
  for (let i = 0; i < n; ++i)
    for (let j = 0; j < 2 * n; ++j) {
      if (i > 0) faces.push([3, at(i, j), at(i + 1, j), at(i, j + 1)]);
      if (i < n - 1) faces.push([3, at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)]);
    }
  const lines = ['OFF', `${points.length} ${faces.length} 0`, ...[...points, ...faces].map((row) => row.join(' ')), ''];
  return new File([lines.join('\n')], 'bumps.off');
}

/** Opens files that are dropped on a window. */
function acceptFiles(target) {
  target.addEventListener('dragover', (event) => event.preventDefault());
  target.addEventListener('drop', (event) => {
    event.preventDefault();
    open(event.dataTransfer.files);
  });
}

acceptFiles(window);
element('pick').addEventListener('change', () => open(element('pick').files));

const sizeOf = (hash) => Number(/^#sample(?:=(\d+))?$/.exec(hash)?.[1] ?? 72);
for (const link of document.querySelectorAll('a[href^="#sample"]'))
  link.addEventListener('click', () => open([sample(sizeOf(link.hash))]));
if (location.hash.startsWith('#sample')) open([sample(sizeOf(location.hash))]);
