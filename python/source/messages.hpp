// Texts and messages of the library as Python's.
#pragma once
#include <span>
#include <string_view>

#include <pybind11/pybind11.h>

#include <continuo/language/text/diagnostic.hpp>

namespace continuo::python {

/// A str. Bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] pybind11::str text_of(std::string_view text);

/// A pair of str: the messages as a terminal shows them, and as JSON; None where there are none.
[[nodiscard]] pybind11::object messages_of(std::span<const model::Diagnostic> messages, const model::Source& source);

}  // namespace continuo::python
