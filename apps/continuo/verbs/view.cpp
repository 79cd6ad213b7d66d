// continuo view: the motion live, in the browser.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/page.hpp>
#include <apps/continuo/pictures/recording.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/browser.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/own_process.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <apps/continuo/verbs/own_session.hpp>
#include <apps/continuo/verbs/run.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/live/loop.hpp>
#include <continuo/live/server.hpp>
#include <continuo/live/server/gzip.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

struct ViewRequest {
  ExperimentOptions experiment;
  live::ServerOptions server;
  std::string page_file;
  std::optional<double> speed;
  bool no_open = false, paused = false, json = false;
  bool for_others = false, allow_save = false;
  std::string viewers = "watch";
  std::optional<std::size_t> own_session;
  RecordingRequest recording;
};

/// Beside the model, or in the folder one is in where none is named; else in the tree that the command was built in, or
/// where it is installed.
std::vector<live::GalleryModel> gallery_for(const std::string& file) {
  std::error_code error;
  const fs::path folder = file.empty() ? fs::current_path(error) : fs::absolute(file, error).parent_path();
  const fs::path command = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {folder.filename() == "models" ? folder : folder / "models", command / "../models",
                                command / "../share/continuo/models", fs::path(CONTINUO_INSTALLED_MODELS)}) {
    auto found = live::gallery_in(place.lexically_normal().string());
    if (!found.empty()) return found;
  }
  return live::gallery_in(folder.string());
}

/// What --set, --method and their like ask for, as if somebody had done it by hand.
bool apply_options(const ExperimentOptions& options, live::Session& session) {
  for (const std::string& text : options.settings) {
    std::vector<model::Diagnostic> problems;
    const auto setting = parse_setting(session.shown().model(), text, problems);
    show(problems, model::Source("--set", text));
    if (!setting) return false;
    session.set_parameter(setting->name, setting->value);
  }
  live::MethodChoice choice{.name = options.method, .step = options.step};
  for (const std::string& text : options.tolerances) {
    std::vector<model::Diagnostic> problems;
    const auto setting = parse_tolerance(session.shown().model(), model::ToleranceKind::relative, text, problems);
    show(problems, model::Source("--tol", text));
    if (!setting) return false;
    choice.rtol = setting->value;
  }
  if ((choice.name || choice.step || choice.rtol) && !session.take_method(choice)) {
    for (const model::Diagnostic& problem : session.problems())
      say(problem.help.empty() ? problem.message : fmt::format("{} ({})", problem.message, problem.help));
    return false;
  }
  if (!options.settings.empty() || choice.name || choice.step || choice.rtol) session.reset();
  return true;
}

/// Of the whole text, finite.
std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  return good ? std::optional(value) : std::nullopt;
}

std::optional<std::string> page_of(const ViewRequest& request) {
  if (request.page_file.empty()) return std::string(built_in_page());
  if (!readable(request.page_file)) return std::nullopt;
  return live::stored(contents_of(request.page_file));
}

/// Where the motion can be seen.
void print_addresses(const ViewRequest& request, const live::Server& server) {
  if (request.for_others) {
    print(fmt::format("presenter: {}\nviewers:   {}\n", server.url(), server.viewers_url()));
  } else {
    print(fmt::format("{}\n", server.url()));
  }
  std::fflush(stdout);
}

ExitCode show_to_the_world(const ViewRequest& request, std::vector<std::string> models, live::Session& session,
                           live::Server& server) {
  const std::atomic<bool>& interrupted = interrupt_flag();
  live::Loop loop(session, [&](std::uint64_t client, const std::string& problem) { server.complain(client, problem); });
  OwnSessions own_sessions(std::move(models));
  std::atomic<bool> begun = request.paused;
  server.start(
      {.command = [&](live::Command command, std::uint64_t client) { return loop.post(std::move(command), client); },
       .rate = [&](double pictures) { loop.set_rate(pictures); },
       .attached =
           [&](std::size_t presenters) {
             if (presenters > 0 && !begun.exchange(true)) loop.post({"play", R"({"do": "play"})"}, 0);
           },
       .watch = [&] { return loop.watch(); },
       .own_session = [&](const live::OwnSession& wanted) { return own_sessions.start(wanted); }});
  loop.start();
  const bool quiet = request.no_open;
  mention("Ctrl-C ends the view");
  if (request.json) {
    nlohmann::ordered_json fields{{"address", server.url()}, {"file", name_of_file(request.experiment.file)}};
    if (request.for_others) fields["viewers"] = server.viewers_url();
    answer("continuo.view/1", std::move(fields));
    print_answer_now();
  } else {
    print_addresses(request, server);
  }
  if (!quiet) open_browser(server.first_url());
  while (!interrupted.load()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  loop.stop();
  server.stop();
  return done;
}

/// The model in the session, as the command line wants it.
ExitCode open_session(const ViewRequest& request, live::Session& session) {
  const model::Loaded loaded = session.open_file();
  show(loaded.diagnostics, loaded.source);
  if (!loaded.model) {
    if (request.recording.wanted()) return wrong_model;
    session.open_mistaken(loaded);
    say("the page opens at the first error; the model runs as soon as its text is mended there");
    return done;
  }
  if (!session.is_open()) {
    show(session.problems(), loaded.source);
    if (!runs::kind_of(*loaded.model).has_start)
      say(
          fmt::format("the live view needs an initial-value problem; this model is a boundary-value problem: `continuo "
                      "report {}` draws its solution",
                      request.experiment.file));
    return usage;
  }
  if (!apply_options(request.experiment, session)) return usage;
  if (request.speed) session.set_speed(*request.speed);
  return done;
}

/// Whether the model can be read, and no output is the model; says what is wrong. Without a model the page begins with
/// the gallery.
bool files_are_in_order(const ViewRequest& request, const std::vector<live::GalleryModel>& gallery) {
  const std::string& file = request.experiment.file;
  if (file.empty()) {
    if (gallery.empty()) say("there is no gallery here; name a model: `continuo view FILE`");
    if (request.recording.wanted()) say("--export and --record need a model: `continuo view FILE`");
    return !gallery.empty() && !request.recording.wanted();
  }
  if (!readable(file)) {
    if (std::error_code error; fs::exists(file, error)) return false;
    const std::string wanted = fs::path(file).stem().string();
    std::vector<std::string> names;
    for (const live::GalleryModel& model : gallery) names.push_back(model.name);
    const bool known = std::ranges::find(names, wanted) != names.end();
    const auto near = known ? std::optional(wanted) : model::suggest(wanted, names);
    const auto found = near ? std::ranges::find(gallery, *near, &live::GalleryModel::name) : gallery.end();
    // What is near in the folder of the file has been said.
    if (found != gallery.end() && fs::proximate(found->path).parent_path() != fs::path(file).parent_path())
      say(fmt::format("the gallery has {}", fs::proximate(found->path).string()));
    say("`continuo view` alone opens the gallery");
    return false;
  }
  return true;
}

ExitCode view(ViewRequest& request) {
  const std::vector<live::GalleryModel> gallery = gallery_for(request.experiment.file);
  if (request.own_session) return serve_own_session(request.experiment.file, gallery, *request.own_session);
  if (request.experiment.file == standard_input) {
    say("view needs a file, which its page shows and saves: give it a name, or let run and report read standard input");
    return usage;
  }
  if (!files_are_in_order(request, gallery)) return usage;
  const auto page = page_of(request);
  if (!page) return usage;
  request.server.page = *page;
  request.server.model_path = request.experiment.file;
  request.server.may_save = !request.for_others || request.allow_save;
  const auto set_up = [&](live::Session& session) { return open_session(request, session); };
  if (request.recording.wanted()) {
    request.recording.model = request.experiment.file;
    request.recording.until = request.experiment.until;
    const ExitCode exit = record(request.recording, set_up, *page);
    if (request.json && exit == done) {
      const auto file_or_null = [](const std::string& path) { return path.empty() ? Json() : Json(path); };
      answer("continuo.recording/1",
             {{"page", file_or_null(request.recording.page)}, {"pictures", file_or_null(request.recording.pictures)}});
    }
    return exit;
  }
  if (page->empty())
    say("this build has no page: build with -DCONTINUO_PAGE=ON (needs npm), or give --page FILE; other clients can use "
        "the address (docs/protocol.md)");
  live::Server server(request.server, [](const std::string& text) { say(text); });
  const live::Place place{.path = request.experiment.file, .gallery = gallery, .writable = request.server.may_save};
  std::vector<std::string> models;
  if (!place.path.empty()) models.push_back(place.path);
  for (const live::GalleryModel& model : place.gallery) models.push_back(model.path);
  live::Session session(live::steady_seconds, server, place);
  if (const Status status = server.listen(); !status) {
    say(status.message);
    return usage;
  }
  if (const ExitCode exit = set_up(session); exit != done) return exit;
  return show_to_the_world(request, std::move(models), session, server);
}

}  // namespace

ExitCode film(const ExperimentOptions& experiment, const std::string& path) {
  ViewRequest request;
  request.experiment = experiment;
  request.recording = {.page = {}, .pictures = path, .model = experiment.file, .until = experiment.until};
  return record(request.recording, [&](live::Session& session) { return open_session(request, session); }, {});
}

namespace {

std::string speed_fault(const std::string& text) {
  const auto speed = number_of(text);
  return speed && *speed >= 0 ? "" : fmt::format("a speed is a number, 0 or more, not {}", text);
}
std::string port_fault(const std::string& text) {
  const auto port = number_of(text);
  return port && *port >= 0 && *port <= 65535 && *port == std::floor(*port)
             ? ""
             : fmt::format("a port is a number up to 65535, not {}", text);
}

}  // namespace

void add_view(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo view                                              the gallery\n"
      "  continuo view models/spring_pendulum.sim                   live in the browser: drag the mass, slide k\n"
      "  continuo view ball.sim --method euler --step 0.1           by Euler's method\n"
      "  continuo view ball.sim --export ball.html                  one page that replays the run, for a lecture\n"
      "  continuo view ball.sim --record frames/                    pictures, without a browser\n"
      "  continuo view ball.sim --record ball.gif                   a film\n"
      "  continuo view ball.sim --listen 0.0.0.0 --port 8000        for a class: an address for you, one for viewers\n"
      "  continuo view ball.sim --listen 0.0.0.0 --viewers own      and each of them may change it for themselves\n";
  Verb* verb = add_verb(app, listed("view"), examples, {wrong_model});
  verb->json_examples = {"continuo view models/pendulum.sim --export pendulum.html --until 1 --json"};
  auto request = std::make_shared<ViewRequest>();
  add_model(*verb, request->experiment);
  verb->get_option("file")->required(false)->description("The model; without one the page begins with the gallery");
  add_method(*verb, request->experiment);
  verb->add_option("--until", request->experiment.until, "End time of the run, for --export and --record")
      ->type_name("T");
  verb->add_option("--speed", request->speed, "Speed as a multiple of real time; 0: as fast as possible")
      ->type_name("K")
      ->check(CLI::Validator(speed_fault, ""));
  verb->add_flag("--paused", request->paused, "Starts in pause");
  verb->add_flag("--no-open", request->no_open, "Prints the address and opens no browser");
  const CLI::Option* listen =
      verb->add_option(
              "--listen", request->server.address,
              "Address of the server: 127.0.0.1 is reachable from this computer only, 0.0.0.0 from the network")
          ->type_name("ADDRESS");
  verb->add_option("--port", request->server.port, "Port of the server (default: any free port)")
      ->type_name("N")
      ->check(CLI::Validator(port_fault, ""));
  reads_file(*verb, verb->add_option("--page", request->page_file, "Serves this page in place of the built-in one"));
  writes_file(*verb,
              verb->add_option("--export", request->recording.page, "Writes one page that replays the run, and ends"),
              {".html"});
  writes_pictures(*verb, verb->add_option("--record", request->recording.pictures,
                                          "Writes pictures to a folder, or a film (.gif; .mp4 by ffmpeg)"));
  verb->add_option("--fps", request->recording.rate, "Pictures per second, for --export and --record")
      ->type_name("N")
      ->check(CLI::Range(1, 120));
  verb->add_flag("--json", request->json, "The address, or the files of --export and --record, as one JSON object");
  verb->add_flag("--allow-save", request->allow_save, "With --listen: the presenter's page may write the file");
  verb->add_option("--viewers", request->viewers,
                   "What the viewers' address allows: watch, or own, a session of one's own beside the presenter's")
      ->type_name("watch|own")
      ->check(CLI::IsMember({"watch", "own"}));
  verb->add_option("--own-session", request->own_session)->group("");  // of a viewer, begun by the presenter's
  verb->callback([&exit, request, listen] {
    request->for_others = listen->count() > 0;
    request->server.own_sessions = request->viewers == "own";
    exit = view(*request);
  });
}

}  // namespace continuo::app
