// Runs of worlds as files of blocks: the contents of every part, and the order of parts.
#include <algorithm>
#include <cmath>
#include <utility>

#include <continuo/simulation/drive/recorded_parts.hpp>
#include <continuo/worlds/run_log.hpp>

namespace continuo::worlds {

namespace {

constexpr FileFormat run_format{
    {'c', 'o', 'n', 't', 'i', 'r', 'u', 'n'}, 3, "this is no recording of a run", "a recording of another version"};
enum class Part : std::uint8_t { head, note, checkpoint, end };

}  // namespace

// The contents of every part, for writing and reading. Found by their arguments, so that they are in this namespace.

using model::recorded::transfer;
using model::recorded::transfer_list;

template <class Archive>
void transfer(Archive& archive, Note& note) {
  archive(note.kind), archive(note.t);
  archive(note.x), archive(note.before);
  archive(note.is_row), archive(note.is_sampled), archive(note.until);
  transfer(archive, note.name), archive(note.impulse);
  transfer_list(archive, note.names);
  if constexpr (Archive::reads) archive.expect(note.kind <= Note::Kind::finish, "a note of no known kind");
}
template <class Archive>
void transfer(Archive& archive, Checkpoint& checkpoint) {
  Snapshot& world = checkpoint.world;
  archive(world.bodies), archive(world.equations), archive(world.variables), archive(world.characters);
  archive(world.time), archive(world.start), archive(world.steps);
  auto collisions = static_cast<std::uint64_t>(world.collisions), mode = static_cast<std::uint64_t>(world.mode);
  archive(collisions), archive(mode);
  transfer(archive, world.method), archive(world.step);
  archive(checkpoint.next_output), archive(checkpoint.next_sample), archive(checkpoint.contacts),
      archive(checkpoint.stops);
  if constexpr (Archive::reads) {
    world.collisions = static_cast<std::size_t>(collisions), world.mode = static_cast<std::size_t>(mode);
    archive.expect(std::isfinite(world.time) && std::isfinite(world.start), "a checkpoint at no time");
  }
}
using model::recorded::bytes_of;
using model::recorded::read_part;

void tell(model::RunRecorder& recorder, const Note& note) {
  switch (note.kind) {
    case Note::Kind::begin:
      return recorder.begin(note.t, note.x);
    case Note::Kind::arrival:
      if (note.is_sampled) recorder.sample_until(note.until, note.x);
      if (!note.is_row) return recorder.look(note.t, note.x);
      return recorder.on_segment(
          note.t, model::At{const_cast<std::vector<double>*>(&note.x), [](void* from, double, std::vector<double>& x) {
                              x = *static_cast<const std::vector<double>*>(from);
                            }});
    case Note::Kind::contact:
      return recorder.contact(note.t, note.name, note.impulse);
    case Note::Kind::event:
      return recorder.on_event(note.t, note.names, note.before, note.x);
    case Note::Kind::finish:
      return recorder.finish(note.t, note.x);
  }
}

RunLog::RunLog(std::ostream& out, const RunHead& head, std::size_t checkpoints) : out_(out), checkpoints_(checkpoints) {
  ByteWriter writer;
  run_format.write(writer);
  out_.write(writer.bytes());
  out_.write(Part::head, bytes_of(head));
}
void RunLog::add(const Note& note) {
  out_.write(Part::note, bytes_of(note));
}
/// Flushes the file, so that a run that is killed keeps everything up to this checkpoint.
void RunLog::add(const Checkpoint& checkpoint) {
  out_.write(Part::checkpoint, bytes_of(checkpoint));
  out_.flush();
}
void RunLog::add(const RunEnd& end) {
  out_.write(Part::end, bytes_of(end));
  out_.flush();
}

Result<RunRecording> RunRecording::read(std::span<const std::byte> bytes) {
  RunRecording recording;
  ByteReader reader(bytes);
  run_format.expect(reader);
  bool has_head = false;
  while (!recording.end) {
    const auto block = next_block(reader, Part::end);
    if (!block) break;
    reader.expect(has_head == (block->kind != Part::head), "blocks in another order");
    if (!reader.ok()) break;
    if (block->kind == Part::head) {
      read_part(reader, block->bytes, recording.head);
      has_head = true;
    } else if (block->kind == Part::note) {
      read_part(reader, block->bytes, recording.notes.emplace_back());
      const bool is_first = recording.notes.size() == 1;
      reader.expect((recording.notes.back().kind == Note::Kind::begin) == is_first, "notes in another order");
    } else if (block->kind == Part::checkpoint) {
      read_part(reader, block->bytes, recording.checkpoints.emplace_back());
      recording.checkpoints.back().notes = recording.notes.size();
    } else {
      read_part(reader, block->bytes, recording.end.emplace());
    }
  }
  if (reader.ok() && recording.notes.empty())
    reader.fail(has_head ? "it was cut off before its first row" : "it was cut off before it began");
  if (!reader.ok()) return reader.status();
  return recording;
}

std::size_t RunRecording::checkpoint_at(double t) const {
  std::size_t found = 0;
  for (std::size_t i = 0; i < checkpoints.size(); ++i)
    if (checkpoints[i].world.time <= t) found = i;
  return found;
}

}  // namespace continuo::worlds
