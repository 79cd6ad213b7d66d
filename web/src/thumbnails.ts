// Small pictures of the gallery's models, made from the models by `npm run thumbnails`.
const files = import.meta.glob<string>("./thumbnails/*.webp", { eager: true, query: "?inline", import: "default" });

/** The picture of a model, as an address; null where there is none. */
export const thumbnailOf = (name: string): string | null => files[`./thumbnails/${name}.webp`] ?? null;
