// apps/continuo/recording.cpp
#include <apps/continuo/recording.hpp>
#include <apps/continuo/terminal.hpp>

namespace continuo::app {

ExitCode record(const RecordingRequest&, const ExperimentOptions&, const std::string&) {
  say("not yet");
  return usage;
}

}  // namespace continuo::app
