// The page as a handful of static files, with relative paths: it works from any folder of any server.
import { defineConfig } from 'vite';

export default defineConfig({
  base: './',
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact' },
  worker: { format: 'es' },
  build: { target: 'es2022', modulePreload: false, assetsInlineLimit: 8192, chunkSizeWarningLimit: 1200 },
});
