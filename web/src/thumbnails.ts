// Small pictures of the gallery's models, made from the models by `npm run thumbnails`.
import pictures from "./thumbnails.json";

/** The picture of a model, as an address; null where there is none. */
export const thumbnailOf = (name: string): string | null => (pictures as Record<string, string>)[name] ?? null;
