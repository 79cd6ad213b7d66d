// apps/continuo/pictures/recorder.hpp
// An audience that keeps what it sees: slices, and frames as a client would get them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <continuo/live/server/row_log.hpp>

namespace continuo::app {

class Recorder final : public live::Audience {
 public:
  void see(std::shared_ptr<const live::Slice> slice) override;
  void hear(live::Topic topic, std::string json) override;
  /// Forgets all but the newest model: the recording begins here.
  void begin();

  using Slices = std::vector<std::shared_ptr<const live::Slice>>;
  const Slices& slices() const { return slices_; }
  /// The element of docs/protocol.md that makes the page replay.
  std::string element() const;

 private:
  live::RowLog log_;
  live::ReadMark mark_;
  std::string model_;
  std::vector<std::string> events_, messages_;
  std::string frames_;  // (u32 length, frame) one after another
  Slices slices_;
};

}  // namespace continuo::app
