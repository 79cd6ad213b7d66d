// Drawing a world: random sequences of what hands do, against an independent list of what was drawn; what a person has
// written stays, to the byte.
import { expect, test } from "vitest";
import { room, wallThrough, fromSegment } from "../../src/draw/geometry";
import { addBody, addSpring, addWall, changed, freshName, moveTo, moveWall, numberText, remove, wallBase, worldOf, type Item, type Place } from "../../src/draw/world_text";

const board = `# A board.
model Board

world {
  gravity (0, -9.81)   # down { not a brace
  wall floor (0, 1) at 0
  for i in 1..2 { body given[i] at (i, 5) radius 0.1 mass 1 }
  body ball1 at (0, 3) radius 0.3 mass 1   # the first
}

run 0..20 output 0.05
plot world.kinetic
`;

const itemsOf = (text: string): Item[] => worldOf(text)!.items;

test("what is written in plain numbers is read, the rest is left alone", () => {
  const items = itemsOf(board);
  expect(items.map(({ kind }) => kind)).toEqual(["wall", "body"]);
  expect(items[1]).toMatchObject({ name: "ball1", at: { x: 0, y: 3 } });
  expect(worldOf("model M\nx' = 1\n")).toBeNull();
  expect(worldOf("world {\n  dimension 3\n}\n")).toBeNull();
  expect(worldOf("# world {\n")).toBeNull();
  const [body] = itemsOf("world { body a at (r, 2*r) radius r; spring a to (0, 5) stiffness 3 }");
  expect(body).toMatchObject({ kind: "body", at: null, numbers: null });
  expect(itemsOf("world {\n body a radius 1,\n   at (1, 2)\n}")[0]).toMatchObject({ at: { x: 1, y: 2 } });
});

test("new lines stand below their kind, as the neighbours are indented", () => {
  const world = worldOf(board)!;
  const { name, changes } = addBody(board, world, { x: 1.25, y: 2 }, 0.2, 2);
  expect(name).toBe("ball2");
  expect(changed(board, changes)).toBe(board.replace("# the first\n", "# the first\n  body ball2 at (1.25, 2) radius 0.2 mass 1\n"));
  const wall = addWall(board, world, { x: 1, y: 0 }, -4, false, 1);
  expect(changed(board, wall.changes)).toBe(board.replace("at 0\n", "at 0\n  wall left_wall (1, 0) at -4\n"));
  const spring = addSpring(board, world, "ball1", { x: 0, y: 5 }, 1);
  expect(changed(board, spring.changes)).toBe(board.replace("# the first\n", "# the first\n  spring ball1 to (0, 5) stiffness 40 damping 0.2\n"));
  const line = "model M; world { wall floor (0, 1) at 0 }\nrun 0..1\n";
  expect(changed(line, addBody(line, worldOf(line)!, { x: 0, y: 1 }, 0.5, 1).changes)).toBe("model M; world {\n  wall floor (0, 1) at 0\n  body ball1 at (0, 1) radius 0.5 mass 1\n}\nrun 0..1\n");
});

test("names are those of the things, and new", () => {
  expect(freshName("# ball1\nbody ball2 at", "ball", true)).toBe("ball1");
  expect(freshName("wall floor (0, 1)", "floor")).toBe("floor2");
  expect([{ x: 0, y: 1 }, { x: 0, y: -1 }, { x: 1, y: 0 }, { x: -1, y: 0 }, { x: 0.6, y: 0.8 }, { x: 0.6, y: -0.8 }].map(wallBase)).toEqual(["floor", "ceiling", "left_wall", "right_wall", "slope", "roof"]);
  expect([numberText(-0.0001, 2), numberText(1.5, 3), numberText(100, 0), numberText(0.3000001, 2)]).toEqual(["0", "1.5", "100", "0.3"]);
});

test("what the text reads elsewhere cannot be taken away", () => {
  const text = board + "plot ball1.y\n";
  expect(remove(text, worldOf(text)!, itemsOf(text)[1]!)).toEqual({ readIn: 13, name: "ball1" });
  expect(changed(board, remove(board, worldOf(board)!, itemsOf(board)[1]!) as never)).toBe(board.replace(/  body ball1.*\n/, ""));
});

test("a wall has the balls on its free side", () => {
  const same = (value: number): number => value;
  const above = { x: 0, y: 3, radius: 0.5 };
  const below = { x: 0, y: -3, radius: 0.5 };
  expect(wallThrough({ x: -1, y: 0 }, { x: 1, y: 0.01 }, [above], same)).toMatchObject({ normal: { x: 0, y: 1 }, thin: false });
  expect(wallThrough({ x: -1, y: 0 }, { x: 1, y: 0 }, [below], same)).toMatchObject({ normal: { x: 0, y: -1 }, thin: false });
  expect(wallThrough({ x: -1, y: 0 }, { x: 1, y: 0 }, [above, below], same)).toMatchObject({ thin: true });
  expect(wallThrough({ x: -1, y: 3 }, { x: 1, y: 3 }, [above], same)).toBe("cuts");
  expect(room({ x: 0, y: 1 }, [above], [{ normal: { x: 0, y: 1 }, offset: 0, thin: false }])).toBe(1);
  expect(fromSegment({ x: 3, y: 4 }, { x: 0, y: 0 }, { x: 0, y: 0 })).toBe(5);
});

/** Numerical Recipes' quick generator: the same sequence each time. */
function* randoms(seed: number): Generator<number, never> {
  let state = seed >>> 0;
  for (;;) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state / 2 ** 32;
  }
}

/** A sequence of drawings; gives the text and, kept apart from it, what was drawn. */
export function draw(seed: number, steps: number): { text: string; bodies: Map<string, Place & { radius: number }>; walls: Map<string, number>; springs: string[] } {
  const random = randoms(seed);
  const next = (): number => random.next().value;
  const pick = <Of>(from: readonly Of[]): Of | undefined => from[Math.floor(next() * from.length)];
  const at = (): Place => ({ x: Math.round(next() * 200 - 100) / 10 + 0, y: Math.round(next() * 100 + 10) / 10 });
  let text = board;
  const bodies = new Map([["ball1", { x: 0, y: 3, radius: 0.3 }]]);
  const walls = new Map([["floor", 0]]);
  let springs: string[] = [];
  for (let step = 0; step < steps; ++step) {
    const world = worldOf(text)!;
    const what = next();
    const name = pick([...bodies.keys()]);
    const item = world.items.find((each) => each.kind === "body" && each.name === name);
    if (what < 0.35) {
      const place = at();
      const made = addBody(text, world, place, 0.1, 1);
      text = changed(text, made.changes);
      bodies.set(made.name, { ...place, radius: 0.1 });
    } else if (what < 0.5 && item?.kind === "body") {
      const place = at();
      text = changed(text, moveTo(item, place, 1));
      bodies.set(name!, { ...place, radius: bodies.get(name!)!.radius });
    } else if (what < 0.65 && name) {
      const other = pick([...bodies.keys()].filter((each) => each !== name));
      const end = other !== undefined && next() < 0.5 ? other : { x: 20 + step, y: 20 };
      text = changed(text, addSpring(text, world, name, end, 1).changes);
      springs.push(`${name} ${typeof end === "string" ? end : `${end.x},${end.y}`}`);
    } else if (what < 0.75) {
      const offset = -Math.round(next() * 100 + 120) / 10;
      const made = addWall(text, world, pick([{ x: 1, y: 0 }, { x: -1, y: 0 }, { x: 0, y: -1 }])!, offset, false, 1);
      text = changed(text, made.changes);
      walls.set(made.name, offset);
    } else if (what < 0.82) {
      const wall = pick(world.items.filter((each) => each.kind === "wall" && each.name !== "floor"));
      if (wall?.kind !== "wall") continue;
      text = changed(text, moveWall(wall, wall.offset - 1, 1));
      walls.set(wall.name, wall.offset - 1);
    } else {
      const gone = pick(world.items);
      if (!gone) continue;
      const changes = remove(text, world, gone);
      if (!Array.isArray(changes)) throw new Error(`${gone.kind} is read in line ${changes.readIn}`);
      text = changed(text, changes);
      if (gone.kind === "body") {
        bodies.delete(gone.name);
        springs = springs.filter((each) => !each.split(" ").includes(gone.name));
      } else if (gone.kind === "wall") {
        walls.delete(gone.name);
      } else {
        const ends = `${gone.a} ${typeof gone.b === "string" ? gone.b : `${gone.b.x},${gone.b.y}`}`;
        springs.splice(springs.indexOf(ends), 1);
      }
    }
  }
  return { text, bodies, walls, springs };
}

test("after any sequence the text holds what was drawn, and what was written", () => {
  for (let seed = 1; seed <= 40; ++seed) {
    const { text, bodies, walls, springs } = draw(seed, 25);
    const items = itemsOf(text);
    const found = new Map(items.flatMap((item) => (item.kind === "body" ? [[item.name, item.at]] : [])));
    expect([...found.keys()].sort(), text).toEqual([...bodies.keys()].sort());
    for (const [name, { x, y }] of bodies) expect(found.get(name), text).toEqual({ x, y });
    expect(Object.fromEntries(items.flatMap((item) => (item.kind === "wall" ? [[item.name, item.offset]] : []))), text).toEqual(Object.fromEntries(walls));
    expect(items.flatMap((item) => (item.kind === "spring" ? [`${item.a} ${typeof item.b === "string" ? item.b : `${item.b.x},${item.b.y}`}`] : [])).sort(), text).toEqual([...springs].sort());
    // Without the lines that were drawn both texts are the same.
    const written = (whole: string): string => whole.split("\n").filter((line) => !/^\s*(body|wall|spring) /.test(line)).join("\n");
    expect(written(text)).toBe(written(board));
  }
});
