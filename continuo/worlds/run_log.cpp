// Runs of worlds as files of blocks: the contents of every part, and the order of parts.
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <continuo/worlds/run_log.hpp>

namespace continuo::worlds {

namespace {

constexpr FileFormat run_format{
    {'c', 'o', 'n', 't', 'i', 'r', 'u', 'n'}, 1, "this is no recording of a run", "a recording of another version"};
enum class Part : std::uint8_t { head, note, checkpoint, end };

// The contents of every part, for writing and reading.

template <class Archive, class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void transfer(Archive& archive, T& value) {
  archive(value);
}
template <class Archive>
void transfer(Archive& archive, std::string& text) {
  std::vector<char> letters(text.begin(), text.end());
  archive(letters);
  if constexpr (Archive::reads) text.assign(letters.begin(), letters.end());
}
template <class Archive>
void transfer(Archive& archive, model::EventName& name) {
  transfer(archive, name.event), transfer(archive, name.mark);
}
template <class Archive>
void transfer(Archive& archive, std::pair<std::string, double>& value) {
  transfer(archive, value.first), transfer(archive, value.second);
}
template <class Archive, class T>
void transfer(Archive& archive, std::optional<T>& value) {
  bool is_there = value.has_value();
  archive(is_there);
  if (!is_there) return;
  if constexpr (Archive::reads) value.emplace();
  transfer(archive, *value);
}
template <class Archive, class T>
void transfer_list(Archive& archive, std::vector<T>& values) {
  auto count = static_cast<std::uint64_t>(values.size());
  archive(count);
  if constexpr (Archive::reads) {
    values.clear();
    if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
    for (std::uint64_t i = 0; i < count && archive.ok(); ++i) transfer(archive, values.emplace_back());
  } else {
    for (T& value : values) transfer(archive, value);
  }
}
template <class Archive>
void transfer(Archive& archive, model::Overrides& values) {
  std::vector<std::pair<std::string, double>> list(values.begin(), values.end());
  transfer_list(archive, list);
  if constexpr (Archive::reads) values = model::Overrides(list.begin(), list.end());
}

template <class Archive>
void transfer(Archive& archive, RunHead& head) {
  transfer(archive, head.file), transfer(archive, head.text);
  archive(head.decides_size), archive(head.as_written);
  model::Experiment& e = head.experiment;
  transfer(archive, e.method);
  for (std::optional<double>* number : {&e.rtol, &e.step, &e.from, &e.to, &e.output}) transfer(archive, *number);
  archive(e.output_steps), archive(e.atol), archive(e.keep_rows);
  transfer(archive, e.rtol_of), transfer(archive, e.atol_of), transfer(archive, e.parameters);
}
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
  archive(world.bodies), archive(world.equations), archive(world.variables);
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
template <class Archive>
void transfer(Archive& archive, RunEnd& end) {
  Outcome<double>& o = end.outcome;
  archive(o.ending), archive(o.t), archive(o.h), archive(o.error), archive(o.limit_time);
  for (std::string* text : {&o.component, &o.event, &o.hint, &end.stop_text, &end.error}) transfer(archive, *text);
  archive(end.seconds);
  if constexpr (Archive::reads) {
    const auto ending = static_cast<int>(o.ending);
    archive.expect(ending >= 0 && ending <= static_cast<int>(last_ending), "an end of no known kind");
  }
}

template <class T>
Bytes bytes_of(const T& part) {
  ByteWriter writer;
  transfer(writer, const_cast<T&>(part));  // a writer only reads it
  return writer.take();
}
template <class T>
void read_part(ByteReader& file, std::span<const std::byte> block, T& part) {
  read_block(file, block, [&](ByteReader& reader) { transfer(reader, part); });
}

}  // namespace

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
