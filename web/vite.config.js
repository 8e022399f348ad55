// The page as a handful of static files, with relative paths: it works from any folder of any server. Each file lies
// beside itself compressed, as the program carries it.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { defineConfig } from 'vite';

function compress_all(folder) {
  for (const name of readdirSync(folder)) {
    const path = join(folder, name);
    if (statSync(path).isDirectory()) compress_all(path);
    else if (!name.endsWith('.gz')) writeFileSync(`${path}.gz`, gzipSync(readFileSync(path), { level: 9 }));
  }
}

// The robot's chunks are fetched beside the page's own, not after it.
const preload = {
  name: 'preload',
  apply: 'build',
  transformIndexHtml: (_, { bundle }) =>
    Object.values(bundle)
      .filter((chunk) => /^(robot_view|stage)/.test(chunk.name ?? ''))
      .map((chunk) => ({ tag: 'link', attrs: { rel: 'modulepreload', crossorigin: true, href: `./${chunk.fileName}` }, injectTo: 'head' })),
};

export default defineConfig({
  base: './',
  plugins: [preload, { name: 'compress', apply: 'build', closeBundle: () => compress_all('dist') }],
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  worker: { format: 'es' },
  build: { target: 'es2022', modulePreload: false, assetsInlineLimit: 8192, chunkSizeWarningLimit: 1200 },
});
