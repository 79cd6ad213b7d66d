// Makes Python's texts and messages.
#include "messages.hpp"

namespace continuo::python {

namespace py = pybind11;

py::str text_of(std::string_view text) {
  PyObject* decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::object messages_of(std::span<const model::Diagnostic> messages, const model::Source& source) {
  if (messages.empty()) return py::none();
  return py::make_tuple(text_of(model::render(messages, source)), text_of(model::to_json(messages, source)));
}

}  // namespace continuo::python
