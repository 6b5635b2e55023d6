// Bundle viewer.js into viewer.min.js, the same bytes from the same lock file, and write down the
// licences of what is in it.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { build } from 'esbuild';

const made = await build({
  entryPoints: ['viewer.js'],
  outfile: 'viewer.min.js',
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2021',
  charset: 'ascii',
  legalComments: 'none',
  metafile: true,
});

function licence(folder) {
  const file = ['LICENSE', 'LICENSE.md', 'LICENSE.txt'].find((name) => existsSync(`${folder}/${name}`));
  if (file) return readFileSync(`${folder}/${file}`, 'utf8');
  // Some packages have their licence at the end of their description.
  const [, text] = readFileSync(`${folder}/README.md`, 'utf8').match(/^LICENSE.*\n-+\n([^]*)$/m);
  return text;
}

const [{ inputs }] = Object.values(made.metafile.outputs);
const used = Object.keys(inputs).filter((path) => inputs[path].bytesInOutput);
const parts = used.map((path) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1]).filter(Boolean);
const texts = [...new Set(parts)].sort().map((name) => {
  const { version, license } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, 'utf8'));
  return `${name} ${version} (${license})\n\n${licence(`node_modules/${name}`).trim()}\n`;
});
const text = `viewer.min.js holds parts of these packages.\n\n${texts.join('\n----\n\n')}`;
writeFileSync('LICENSES.txt', text.replace(/[ \t\r]+$/gm, ''));
