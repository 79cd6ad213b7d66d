// Puts the page together: its parts, its keys, its address.
import { fromHash, galleryName, toHash } from "./address";
import { ControlPanel } from "./controls/panel";
import { icon, iconButton, make, setText } from "./dom";
import { Board } from "./draw/board";
import { Editor } from "./editor/editor";
import { Mistakes } from "./editor/mistakes";
import { openGallery } from "./gallery";
import { headingElement } from "./heading";
import { listenToKeys, openHelp, type Action } from "./keyboard";
import { Messages } from "./messages";
import { PlotPanel } from "./plots/panel";
import { savePicture } from "./plots/export";
import { specFromText } from "./plots/specs";
import type { ModelMessage } from "./protocol";
import { Room } from "./room";
import { SceneView } from "./scene/view";
import type { Session } from "./session";
import { ThemeChoice } from "./theme";
import { Transport } from "./transport";

/** The model of the gallery that is there to be drawn in. */
const drawingBoard = "drawing_board";

export class App {
  readonly scene: SceneView;
  private readonly plots: PlotPanel;
  private readonly controls: ControlPanel;
  private readonly editor: Editor;
  private readonly board: Board;
  private readonly transport: Transport;
  private readonly theme: ThemeChoice;
  private readonly messages: Messages;
  private readonly mistakes: Mistakes;
  private readonly heading = make("div", { class: "heading-place" });
  private readonly vectorButton = iconButton("arrows", "Arrows: velocity and acceleration", "a", () => this.toggleVectors());
  private readonly modelName = make("span", { class: "model-name" });
  private readonly root: HTMLElement;
  private readonly actions: Action[];
  private hashTimer = 0;
  private hashDone = false;
  private toldNoPicture = false;

  constructor(
    private readonly session: Session,
    host: HTMLElement,
    readonly embedded: boolean,
  ) {
    this.theme = new ThemeChoice((theme) => session.tell("theme", theme));
    this.root = make("div", { class: `app ${embedded ? "embed" : ""} ${session.live ? "" : "recorded"}`, "data-tab": "controls" });
    host.replaceChildren(this.root);
    this.scene = new SceneView(session, this.theme.theme, () => this.remember());
    this.plots = new PlotPanel(session, this.theme.theme);
    this.plots.changed = () => this.remember();
    this.controls = new ControlPanel(session);
    this.editor = new Editor(session);
    this.board = new Board(session, this.scene, this.editor);
    this.scene.element.append(this.board.element);
    this.board.toggled = (on) => {
      this.root.classList.toggle("drawing", on);
      if (on && innerWidth > 900) this.showEditor(true);
    };
    this.transport = new Transport(session);
    this.mistakes = new Mistakes((line, column) => this.editor.goTo(line, column));
    this.messages = new Messages(session, (line, column) => {
      this.showEditor(true);
      this.editor.goTo(line, column);
    });
    this.actions = this.makeActions();
    this.layOut();
    this.listen();
  }

  private layOut(): void {
    const gallery = make("button", { type: "button", class: "gallery-button", title: "Gallery (g)", "aria-keyshortcuts": "g", onclick: () => this.openGallery() }, icon("gallery"), this.modelName);
    const top = make(
      "header",
      { class: "top" },
      gallery,
      this.transport.element,
      new Room(this.session).element,
      make(
        "div",
        { class: "tools" },
        iconButton("text", "The model's text", "e", () => this.toggleEditor()),
        iconButton("pencil", "Draw balls, walls and springs", "w", () => this.draw()),
        this.vectorButton,
        iconButton("picture", "Save the scene as PNG", "", () => this.saveScene()),
        iconButton("share", "Copy the address with parameters and view", "", () => void this.share()),
        iconButton("big", "Larger letters, for a projector", "b", () => this.toggleBig()),
        iconButton("fit", "Present: the scene on the whole screen", "s", () => this.present()),
        iconButton("theme", "Light or dark", "t", () => this.theme.toggle()),
        iconButton("help", "Help", "?", () => this.help()),
      ),
      make(
        "div",
        { class: "present-tools" },
        make("button", { type: "button", class: "framed", title: "Plots beside the scene (o)", "aria-keyshortcuts": "o", onclick: () => this.togglePlots() }, "Plots"),
        make("button", { type: "button", class: "framed", title: "End the presentation (Escape)", "aria-keyshortcuts": "Escape", onclick: () => this.endPresentation() }, "End"),
      ),
    );
    const tabs = make("nav", { class: "tabs", "aria-label": "Parts of the page" });
    for (const [tab, words] of [["controls", "Controls"], ["plots", "Plots"], ["model", "Model"]] as const) {
      const button = make("button", { type: "button", "aria-pressed": tab === "controls" ? "true" : "false", onclick: () => {
        this.root.dataset["tab"] = tab;
        for (const each of tabs.children) each.setAttribute("aria-pressed", String(each === button));
        this.plots.invalidate();
      } }, words);
      tabs.append(button);
    }
    const handle = make("div", { class: "handle", role: "separator", tabindex: 0, "aria-orientation": "horizontal", "aria-label": "Size of the plots", "aria-valuemin": 12, "aria-valuemax": 85, "aria-valuenow": 40, title: "Drag to resize scene and plots" });
    const middle = make("main", { class: "middle" }, this.heading, this.mistakes.element, this.scene.element, handle, this.plots.element);
    this.makeHandle(handle, middle);
    const parts = this.embedded ? [top, this.messages.element, this.scene.element] : [top, this.messages.element, this.editor.element, middle, tabs, this.controls.element];
    this.root.append(...parts);
  }

  private makeHandle(handle: HTMLElement, middle: HTMLElement): void {
    const give = (percent: number): void => {
      const share = Math.round(Math.min(85, Math.max(12, percent)));
      middle.style.setProperty("--plots", `${share}%`);
      handle.setAttribute("aria-valuenow", String(share));
    };
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      const move = (moved: PointerEvent): void => {
        const box = middle.getBoundingClientRect();
        give((100 * (box.bottom - moved.clientY)) / box.height);
      };
      handle.addEventListener("pointermove", move);
      handle.addEventListener("pointerup", () => handle.removeEventListener("pointermove", move), { once: true });
    });
    handle.addEventListener("keydown", (event) => {
      const by = event.key === "ArrowUp" ? 4 : event.key === "ArrowDown" ? -4 : 0;
      if (by === 0) return;
      event.preventDefault();
      event.stopPropagation();
      give(Number(handle.getAttribute("aria-valuenow")) + by);
    });
  }

  private listen(): void {
    const { session } = this;
    session.on("model", (model) => this.open(model));
    session.on("state", () => this.remember());
    listenToKeys(this.actions, (key, shift, down) => this.controls.key(key, shift, down), () => this.scene.hand.letGo());
    addEventListener("hashchange", () => this.applyHash());
    // Escape leaves the full screen, and with it the presentation.
    document.addEventListener("fullscreenchange", () => {
      if (!document.fullscreenElement) this.endPresentation();
    });
  }

  private open(model: ModelMessage): void {
    document.title = `${model.name} – Continuo`;
    setText(this.modelName, this.session.live ? "Gallery" : model.name);
    this.heading.replaceChildren(headingElement(model.name, model.heading));
    const mistakes = model.mistakes ?? [];
    this.root.classList.toggle("bare", this.scene.empty);
    this.root.classList.toggle("mistaken", mistakes.length > 0);
    if (mistakes.length > 0) {
      this.showEditor(true);
      this.editor.showMistakes(mistakes);
    }
    this.mistakes.show(model.path, mistakes);
    if (this.drawNext && galleryName(model) === drawingBoard) {
      this.drawNext = false;
      // When the first picture has set the frame.
      requestAnimationFrame(() => requestAnimationFrame(() => this.board.begin()));
    }
    if (!this.scene.stage.surface.works && !this.toldNoPicture) {
      this.toldNoPicture = true;
      this.session.said({ say: "message", severity: "warning", code: null, text: "This browser cannot draw scenes, since it has no WebGL.", hint: "Plots and values are available.", line: null, column: null });
    }
    this.root.classList.toggle("small-gallery", model.gallery.length === 0);
    if (!this.hashDone) {
      this.hashDone = true;
      const wanted = fromHash(location.hash).model;
      if (this.session.live && wanted && wanted !== galleryName(model) && model.gallery.some(({ name }) => name === wanted)) {
        this.hashDone = false;  // the rest of the address is that model's
        this.session.send({ do: "open", model: wanted });
        return;
      }
      this.applyHash();
      if (model.welcome && !wanted) {
        this.choosing = true;
        this.openGallery();
      }
    } else {
      this.written = "";
    }
  }

  private toggleVectors(): void {
    this.vectorButton.setAttribute("aria-pressed", String(this.scene.toggleVectors()));
  }

  /** Nobody has chosen a model yet. Until then the address names none, so that a page that is reloaded begins with its
   *  gallery again. */
  private choosing = false;

  private openGallery(): void {
    openGallery(this.session, this.session.model?.gallery.some(({ name }) => name === drawingBoard) ? () => this.draw() : null, () => {
      this.choosing = false;
      this.remember();
    });
  }

  private drawNext = false;

  /** In the world that is shown, else on an empty board of the gallery. */
  private draw(): void {
    if (this.board.active) return this.board.end();
    if (this.board.possible) return this.board.begin();
    if (!this.session.live || !this.session.model?.gallery.some(({ name }) => name === drawingBoard)) {
      return this.session.said({ say: "message", severity: "note", code: null, text: "Only worlds in the plane can be drawn in.", hint: "A model with `world { }` is needed: `continuo new NAME --template world` writes one.", line: null, column: null });
    }
    this.drawNext = true;
    this.session.send({ do: "pause" });
    this.session.send({ do: "open", model: drawingBoard });
  }

  private written = "";

  /** Takes parameters, method and view from the address. */
  private applyHash(): void {
    const { model } = this.session;
    if (!model || location.hash === this.written) return;
    const shared = fromHash(location.hash);
    if (this.session.live) {
      for (const { name, value } of model.parameters) {
        const wanted = shared.parameters[name];
        if (wanted !== undefined && wanted !== value) this.session.send({ do: "set", parameter: name, value: wanted });
      }
      for (const { name } of model.inputs) if (shared.inputs[name] !== undefined) this.session.send({ do: "input", name, value: shared.inputs[name] });
      const known = (name: string): boolean => model.methods.some((method) => method.name === name);
      if (shared.method && known(shared.method.name)) this.session.send({ do: "method", ...shared.method });
      if (shared.ghost && known(shared.ghost.name)) this.session.send({ do: "ghost", ...shared.ghost });
      if (shared.speed !== undefined) this.session.send({ do: "speed", value: shared.speed });
    }
    for (const [index, text] of shared.plots.entries()) {
      const spec = specFromText(text, model.columns, `shared${index}`);
      if (spec && !this.plots.customPlots.includes(text)) this.plots.add(spec);
    }
    if (shared.view) this.scene.stage.view = shared.view;
  }

  /** Writes what the address carries, a little later: browsers limit how often. */
  private remember(): void {
    if (this.embedded || this.hashTimer || !this.hashDone || this.choosing) return;
    this.hashTimer = window.setTimeout(() => {
      this.hashTimer = 0;
      const { model, state } = this.session;
      if (!model || !this.session.live) return;
      const hash = `#${toHash(model, state, this.scene.stage.automatic ? null : this.scene.stage.view, this.plots.customPlots)}`;
      if (hash === this.written) return;
      this.written = hash;
      history.replaceState(null, "", hash === "#" ? location.pathname + location.search : hash);
    }, 600);
  }

  private async share(): Promise<void> {
    await navigator.clipboard?.writeText(location.href).catch(() => undefined);
    this.session.said({ say: "message", severity: "note", code: null, text: "The address of this page has been copied, with its parameters and view.", hint: null, line: null, column: null });
  }

  private saveScene(): void {
    const background = getComputedStyle(this.scene.element).backgroundColor;
    savePicture(`${this.session.model?.name ?? "scene"}.png`, this.scene.picture(background));
  }

  private toggleEditor(): void {
    const shown = this.root.classList.contains("editing");
    this.showEditor(!shown);
    if (!shown) this.editor.focus();
  }

  private showEditor(shown: boolean): void {
    this.root.classList.toggle("editing", shown);
    if (shown) this.root.dataset["tab"] = "model";
    this.scene.stage.invalidate();
  }

  private toggleBig(): void {
    document.documentElement.classList.toggle("big");
    this.restyle();
  }

  /** The size of letters or of the scene has changed. */
  private restyle(): void {
    this.plots.restyle();
    this.scene.stage.invalidate();
  }

  private get presents(): boolean {
    return this.root.classList.contains("present");
  }

  /** For a lecture: the scene on the whole screen, in letters that can be read from the last row. */
  private present(): void {
    if (this.presents) return this.endPresentation();
    this.root.classList.add("present");
    document.documentElement.classList.add("presenting");
    // Who ends it before the screen is full leaves the screen as soon as it is.
    void document.documentElement.requestFullscreen?.().then(() => (this.presents ? undefined : document.exitFullscreen())).catch(() => undefined);
    this.restyle();
  }

  private endPresentation(): void {
    if (!this.presents) return;
    this.root.classList.remove("present");
    document.documentElement.classList.remove("presenting");
    if (document.fullscreenElement) void document.exitFullscreen().catch(() => undefined);
    this.restyle();
  }

  private togglePlots(): void {
    this.root.classList.toggle("present-plots");
    this.restyle();
  }

  private help(): void {
    const keys = (this.session.model?.inputs ?? []).flatMap(({ key, name }) => (key ? [{ key, words: `${name}: held to its largest value, with Shift to its smallest` }] : []));
    openHelp(this.actions, keys);
  }

  private makeActions(): Action[] {
    const { session } = this;
    const send = (name: "step" | "back" | "reset" | "until_event" | "undo" | "restore") => () => session.send({ do: name });
    const { stage, hand } = this.scene;
    const arrow = (key: string, right: number, up: number, words: string, group: Action["group"], otherwise?: () => void): Action => ({
      keys: [key], words, group,
      run: () => {
        if (hand.holdsByKey) hand.shift(0.04 * right, 0.04 * up);
        else otherwise?.();
      },
    });
    const turn = (key: string, right: number, up: number, words = ""): Action => ({ keys: [`Shift+${key}`], also: ["Shift+Arrows"], words, group: "Scene", run: () => stage.turnOrPan(right, up) });
    return [
      { keys: ["Space"], words: "play, pause", group: "Time", run: () => this.transport.toggle() },
      arrow("ArrowRight", 1, 0, "one step on", "Time", send("step")),
      arrow("ArrowLeft", -1, 0, "one step back", "Time", send("back")),
      { keys: ["n"], words: "run until the next event", group: "Time", run: send("until_event") },
      { keys: ["r", "Home"], words: "reset to the start", group: "Time", run: send("reset") },
      { keys: ["["], words: "slower", group: "Time", run: () => this.transport.change(-1) },
      { keys: ["]"], words: "faster", group: "Time", run: () => this.transport.change(1) },
      { keys: ["f"], words: "the whole scene", group: "Scene", run: () => this.scene.fit() },
      { keys: ["+", "="], words: "nearer", group: "Scene", run: () => stage.zoom(1.25) },
      { keys: ["-"], words: "farther", group: "Scene", run: () => stage.zoom(0.8) },
      turn("ArrowLeft", -0.1, 0, "move the picture; in space turn it"),
      turn("ArrowRight", 0.1, 0),
      turn("ArrowUp", 0, 0.1),
      turn("ArrowDown", 0, -0.1),
      { keys: ["v"], words: "the camera follows the selected body, or stays", group: "Scene", run: () => this.scene.toggleFollow() },
      { keys: ["d"], words: "select the next movable object, or the next body", group: "Scene", run: () => void hand.selectNext() },
      { ...arrow("ArrowUp", 0, 1, "drag the selected object", "Scene"), also: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"] },
      arrow("ArrowDown", 0, -1, "", "Scene"),
      { keys: ["j"], words: "joints of bodies", group: "Scene", run: () => void this.scene.toggleJoints() },
      { keys: ["a"], words: "arrows for velocity and acceleration", group: "Scene", run: () => this.toggleVectors() },
      { keys: ["x"], words: "the grid", group: "Scene", run: () => {
        this.scene.gridShown = !this.scene.gridShown;
        stage.invalidate();
      } },
      { keys: ["u"], words: "undo the last change", group: "Page", run: send("undo") },
      { keys: ["p"], words: "parameters as in the file", group: "Page", run: send("restore") },
      { keys: ["c"], words: "to the sliders", group: "Page", run: () => this.controls.focusFirstSlider() },
      { keys: ["m"], words: "go to the list of methods", group: "Page", run: () => this.controls.focusMethod() },
      { keys: ["h"], words: "ghost: a second method beside the first", group: "Page", run: () => this.controls.toggleGhost() },
      { keys: ["e"], words: "the text of the model (Ctrl-Enter runs it, Esc leaves the editor)", group: "Page", run: () => this.toggleEditor() },
      { keys: ["g"], words: "the gallery", group: "Page", run: () => this.openGallery() },
      { keys: ["b"], words: "larger letters", group: "Page", run: () => this.toggleBig() },
      { keys: ["s"], words: "present: the scene on the whole screen; Esc ends it", group: "Page", run: () => this.present() },
      { keys: ["w"], words: "draw balls, walls and springs", group: "Page", run: () => this.draw() },
      { keys: ["o"], words: "while presenting: the plots beside the scene", group: "Page", run: () => this.presents && this.togglePlots() },
      { keys: ["Escape"], words: "", group: "Page", run: () => this.endPresentation() },
      { keys: ["t"], words: "light or dark", group: "Page", run: () => this.theme.toggle() },
      { keys: ["?"], words: "this help", group: "Page", run: () => this.help() },
    ];
  }
}
