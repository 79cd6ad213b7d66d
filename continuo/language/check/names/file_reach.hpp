// continuo/language/check/names/file_reach.hpp
#pragma once

namespace continuo::model {

/// Which files a text may have read: tables, and inputs over time.
enum class FileReach {
  anywhere,      // as its author says, who could read them too
  model_folder,  // those in the folder of the model, and below it; messages about them quote nothing
};

}  // namespace continuo::model
