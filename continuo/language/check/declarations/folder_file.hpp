// continuo/language/check/declarations/folder_file.hpp
#pragma once
#include <string>

#include <continuo/status/result.hpp>

namespace continuo::model::detail {

/// The content of a regular file in a folder or below it. A name that leads out of it is refused, as are links, devices
/// and pipes; nothing that happens to the folder meanwhile changes that. Messages name the file as `name` does, and
/// quote nothing of it.
[[nodiscard]] Result<std::string> read_from_folder(const std::string& folder, const std::string& name);

}  // namespace continuo::model::detail
