// Prints the page of `ahm view` with another transport, as libahm/render/src/write_html.cpp fills it in.
//   node page.mjs libahm/render/src transport.js
import {readFileSync} from 'node:fs';

const [source, transport] = process.argv.slice(2);
const page = `${source}/page`, three = '/usr/share/javascript/three';
const text = (path) => readFileSync(path, 'utf8');
const files = {
  STYLE: `${page}/style.css`, PALETTE: `${source}/palette.glsl`, TRANSPORT_JS: transport, THREE: `${three}/three.min.js`,
  ORBIT_CONTROLS: `${three}/examples/js/controls/OrbitControls.js`,
};
const texts = {TITLE: 'libahm', NONCE: '', SURFACE: '', MAP: ''};
const fill = (whole, name) =>
  texts[name] ?? text(files[name] ?? `${page}/${name.replace(/_JS$/, '').toLowerCase()}.js`);
process.stdout.write(text(`${page}/page.html`).replace(/@([A-Z_]+)@/g, fill));
