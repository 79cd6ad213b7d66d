// continuo/live/session/commands.cpp
// Reads commands from JSON, and calls the session.
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <continuo/live/session/commands.hpp>

namespace continuo::live {

namespace {

using nlohmann::json;

/// A part that is not there, or of another kind.
struct Unfit {
  std::string part;
};

double number(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || !found->is_number()) throw Unfit{std::string(part) + ", a number"};
  return found->get<double>();
}

std::string word(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || !found->is_string()) throw Unfit{std::string(part) + ", a text"};
  return found->get<std::string>();
}

std::optional<double> perhaps_number(const json& command, const char* part) {
  const auto found = command.find(part);
  return found == command.end() || found->is_null() ? std::nullopt : std::optional(number(command, part));
}

bool perhaps_true(const json& command, const char* part) {
  const auto found = command.find(part);
  if (found == command.end() || found->is_null()) return false;
  if (!found->is_boolean()) throw Unfit{std::string(part) + ", true or false"};
  return found->get<bool>();
}

std::size_t index(const json& command, const char* part) {
  const double value = number(command, part);
  if (!(value >= 0 && value < 1e9)) throw Unfit{std::string(part) + ", the number of a thing"};
  return static_cast<std::size_t>(value);
}

MethodChoice method_of(const json& command) {
  return {
      .name = word(command, "name"), .step = perhaps_number(command, "step"), .rtol = perhaps_number(command, "rtol")};
}

void drag(Session& session, const json& command) {
  const auto to = command.find("to");
  if (to == command.end() || !to->is_array() || to->size() > 3) throw Unfit{"to, two or three numbers"};
  std::vector<double> point;
  for (const json& coordinate : *to) {
    if (!coordinate.is_number()) throw Unfit{"to, two or three numbers"};
    point.push_back(coordinate.get<double>());
  }
  if (command.contains("body")) return session.drag_body(index(command, "body"), point);
  session.drag(index(command, "item"), point);
}

using Doing = std::function<void(Session&, const json&)>;

const std::map<std::string, Doing, std::less<>>& doings() {
  static const std::map<std::string, Doing, std::less<>> all = {
      {"play", [](Session& s, const json&) { s.play(); }},
      {"pause", [](Session& s, const json&) { s.pause(); }},
      {"step", [](Session& s, const json&) { s.step(); }},
      {"back", [](Session& s, const json&) { s.back(); }},
      {"reset", [](Session& s, const json&) { s.reset(); }},
      {"until_event", [](Session& s, const json&) { s.until_event(); }},
      {"restore", [](Session& s, const json&) { s.restore_parameters(); }},
      {"undo", [](Session& s, const json&) { s.undo(); }},
      {"release", [](Session& s, const json& c) { s.release(perhaps_true(c, "still")); }},
      {"seek", [](Session& s, const json& c) { s.seek(number(c, "t")); }},
      {"speed", [](Session& s, const json& c) { s.set_speed(number(c, "value")); }},
      {"set", [](Session& s, const json& c) { s.set_parameter(word(c, "parameter"), number(c, "value")); }},
      {"input", [](Session& s, const json& c) { s.move_input(word(c, "name"), number(c, "value")); }},
      {"method", [](Session& s, const json& c) { s.take_method(method_of(c)); }},
      {"ghost",
       [](Session& s, const json& c) {
         const auto name = c.find("name");
         if (name == c.end() || name->is_null()) {
           s.take_ghost(std::nullopt);
         } else {
           s.take_ghost(method_of(c));
         }
       }},
      {"drag", drag},
      {"pick", [](Session& s, const json& c) { s.pick(index(c, "body")); }},
      {"open", [](Session& s, const json& c) { s.open_gallery(word(c, "model")); }},
      {"run", [](Session& s, const json& c) { s.run_text(word(c, "text")); }},
      {"save", [](Session& s, const json& c) { s.save_text(word(c, "text")); }},
  };
  return all;
}

constexpr std::array<std::string_view, 3> of_the_server = {"check", "ping", "rate"};

}  // namespace

Result<Command> read_command(std::string text) {
  const json command = json::parse(text, nullptr, false);
  if (command.is_discarded()) return invalid_input("this is no JSON");
  if (!command.is_object()) return invalid_input("a command is an object");
  const auto what = command.find("do");
  if (what == command.end() || !what->is_string()) return invalid_input("a command has a text `do`");
  std::string name = what->get<std::string>();
  const bool known = doings().contains(name) || std::ranges::find(of_the_server, name) != of_the_server.end();
  if (!known) return invalid_input("there is no such command");
  return Command{std::move(name), std::move(text)};
}

Status obey(Session& session, const Command& command) {
  const auto doing = doings().find(command.what);
  if (doing == doings().end()) return invalid_input("there is no such command");
  try {
    doing->second(session, json::parse(command.text));
  } catch (const Unfit& unfit) {
    return invalid_input("`" + command.what + "` needs " + unfit.part);
  }
  return {};
}

Result<Asked> asked(const Command& command) {
  const json all = json::parse(command.text);
  try {
    if (command.what == "check") return Asked{number(all, "id"), word(all, "text")};
    if (command.what == "ping") return Asked{number(all, "id"), {}};
    if (command.what == "rate") return Asked{number(all, "fps"), {}};
  } catch (const Unfit&) {
  }
  return invalid_input("`" + command.what + "` has a part that does not fit");
}

}  // namespace continuo::live
