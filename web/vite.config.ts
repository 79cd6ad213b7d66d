// One page, one file: the script and the style go into the HTML, so that the executable serves a single text and an
// exported page needs nothing beside it.
import { defineConfig, type Plugin } from "vite";

const inlined = (): Plugin => ({
  name: "inlined",
  enforce: "post",
  generateBundle(_, bundle) {
    const page = bundle["index.html"];
    if (!page || page.type !== "asset") throw new Error("the build made no index.html");
    let html = String(page.source);
    const put = (pattern: RegExp, text: string): void => {
      if (!pattern.test(html)) throw new Error(`nothing in index.html matches ${pattern}`);
      html = html.replace(pattern, () => text);
    };
    for (const [name, part] of Object.entries(bundle)) {
      if (part.type === "chunk") {
        put(/<script type="module"[^>]*><\/script>/, "");
        // At the end of the body: the recording stands before it. `</script` inside a text would end the element.
        put(/<!--script-->/, `<script type="module">${part.code.replaceAll("</script", "<\\/script")}</script>`);
      } else if (name.endsWith(".css")) {
        put(/<link rel="stylesheet"[^>]*>/, `<style>${String(part.source)}</style>`);
      } else {
        continue;
      }
      delete bundle[name];
    }
    if (!html.includes("<!--recording-->")) throw new Error("index.html has lost the place of the recording");
    page.source = html;
  },
});

export default defineConfig({
  plugins: [inlined()],
  build: { target: "es2022", assetsInlineLimit: 1e6, cssCodeSplit: false, modulePreload: false, chunkSizeWarningLimit: 2000 },
  test: { include: ["test/unit/**/*.test.ts"] },
} as Parameters<typeof defineConfig>[0]);
