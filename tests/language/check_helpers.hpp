// tests/language/check_helpers.hpp
// Models from texts, and the messages of their checks.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/load.hpp>

namespace continuo::model {

inline Loaded load_text(std::string text, const CheckOptions& options = {}) {
  return load(Source("model.sim", std::move(text)), options);
}

/// The model; the test fails with its messages where there is none.
inline Model good(std::string text, const CheckOptions& options = {}) {
  Loaded loaded = load_text(std::move(text), options);
  EXPECT_TRUE(loaded) << loaded.text();
  return loaded ? std::move(*loaded.model) : Model{};
}

/// The derivative of a state in a mode, at these values of some variables; the others are as at the start.
inline double rate(const Model& model, std::string_view column, std::vector<std::pair<std::string, double>> at = {},
                   std::size_t mode = 0) {
  std::vector<double> variables = start_values(model);
  for (const auto& [name, value] : at) {
    for (std::uint32_t i = 0; i < variables.size(); ++i) {
      if (variable_name(model, i) == name) variables[i] = value;
    }
  }
  const std::size_t state = find_state(model, column);
  EXPECT_NE(state, npos) << column;
  return state == npos ? 0 : evaluate(model, model.modes[mode].derivatives[state], variables);
}

/// The value of a let, output or energy at the start.
inline double value_of(const Model& model, std::string_view name) {
  for (const auto* list : {&model.lets, &model.outputs, &model.energies}) {
    for (const Quantity& quantity : *list) {
      if (quantity.name == name) return evaluate(model, quantity.node, start_values(model));
    }
  }
  ADD_FAILURE() << "no " << name;
  return 0;
}

struct Said {
  std::string code, message, label, help;
  int line, column;
};

/// The message with this code; the test fails if there is none.
inline Said said(std::string text, std::string_view code, const CheckOptions& options = {}) {
  const Loaded loaded = load_text(std::move(text), options);
  for (const Diagnostic& d : loaded.diagnostics) {
    const Place place = loaded.source.place(d.span.begin);
    if (d.code == code) return {d.code, d.message, d.label, d.help, place.line, place.column};
  }
  ADD_FAILURE() << "no " << code << " in:\n" << loaded.text();
  return {};
}

/// "2:7", line and column.
inline std::string place(const Said& message) {
  return std::to_string(message.line) + ":" + std::to_string(message.column);
}

/// How many messages of any kind.
inline std::size_t count_said(std::string text) {
  return load_text(std::move(text)).diagnostics.size();
}

}  // namespace continuo::model
