// Recordings of integrations as files of blocks: the contents of every part, and the order of parts.
#include <cmath>
#include <utility>

#include <continuo/language/world.hpp>
#include <continuo/simulation/drive/recorded_parts.hpp>
#include <continuo/simulation/integration_recording.hpp>

namespace continuo::model {

namespace {

constexpr FileFormat integration_format{{'c', 'o', 'n', 't', 'i', 'i', 'n', 't'},
                                        1,
                                        "this is no recording of a run",
                                        "a recording of another version of Continuo; run the model again"};
enum class Part : std::uint8_t { head, checkpoint, end };

}  // namespace

// The contents of every part, for writing and reading. Found by their arguments, so that they are in this namespace.

using recorded::transfer;
using recorded::transfer_count;
using recorded::transfer_list;

template <class Archive>
void transfer(Archive& archive, RecordedEvent& event) {
  transfer(archive, event.name), transfer(archive, event.mark);
  archive(event.t), archive(event.before), archive(event.after);
}
template <class Archive>
void transfer(Archive& archive, SampledState& sample) {
  archive(sample.t), archive(sample.x);
}
template <class Archive>
void transfer(Archive& archive, Extremes& extremes) {
  archive(extremes.low), archive(extremes.high), archive(extremes.t_low), archive(extremes.t_high);
}
template <class Archive>
void transfer(Archive& archive, EnergyBalance& energy) {
  archive(energy.first), archive(energy.last), archive(energy.drift);
  transfer(archive, energy.unit), archive(energy.relative);
}
template <class Archive>
void transfer(Archive& archive, RecordedPart& part) {
  archive(part.rows), archive(part.total_energy);
  transfer_list(archive, part.events);
  transfer_count(archive, part.next_output), transfer_count(archive, part.next_sample);
  transfer_list(archive, part.samples), transfer_list(archive, part.extremes);
  bool has_energy = part.energy.has_value();
  archive(has_energy);
  if constexpr (Archive::reads) part.energy = has_energy ? std::optional(EnergyBalance{}) : std::nullopt;
  if (has_energy) transfer(archive, *part.energy);
  archive(part.x), archive(part.last_row), archive(part.any);
}
template <class Archive>
void transfer(Archive& archive, IntegrationCheckpoint& checkpoint) {
  archive(checkpoint.t);
  transfer(archive, checkpoint.part);
  archive(checkpoint.state);
  transfer_count(archive, checkpoint.marks_seen);
  if constexpr (Archive::reads) archive.expect(std::isfinite(checkpoint.t), "a checkpoint at no time");
}
template <class Archive>
void transfer(Archive& archive, IntegrationEnd& end) {
  transfer(archive, end.part), transfer(archive, end.end);
}

IntegrationLog::IntegrationLog(std::ostream& out, const RunHead& head, std::size_t checkpoints)
    : out_(out), checkpoints_(checkpoints) {
  ByteWriter writer;
  integration_format.write(writer);
  out_.write(writer.bytes());
  out_.write(Part::head, recorded::bytes_of(head));
}
void IntegrationLog::add(const IntegrationCheckpoint& checkpoint) {
  out_.write(Part::checkpoint, recorded::bytes_of(checkpoint));
  out_.flush();
}
void IntegrationLog::add(const IntegrationEnd& end) {
  out_.write(Part::end, recorded::bytes_of(end));
  out_.flush();
}

bool IntegrationRecording::is_one(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  std::array<char, 8> name{};
  reader(name);
  return reader.ok() && name == integration_format.name;
}

Result<IntegrationRecording> IntegrationRecording::read(std::span<const std::byte> bytes) {
  IntegrationRecording recording;
  ByteReader reader(bytes);
  integration_format.expect(reader);
  bool has_head = false;
  while (!recording.end) {
    const auto block = next_block(reader, Part::end);
    if (!block) break;
    reader.expect(has_head == (block->kind != Part::head), "blocks in another order");
    if (!reader.ok()) break;
    if (block->kind == Part::head) {
      recorded::read_part(reader, block->bytes, recording.head);
      has_head = true;
    } else if (block->kind == Part::checkpoint) {
      recorded::read_part(reader, block->bytes, recording.checkpoints.emplace_back());
    } else {
      recorded::read_part(reader, block->bytes, recording.end.emplace());
    }
  }
  if (reader.ok() && recording.checkpoints.empty() && !recording.end)
    reader.fail(has_head ? "it was cut off before its first checkpoint" : "it was cut off before it began");
  if (!reader.ok()) return reader.status();
  return recording;
}

std::size_t IntegrationRecording::checkpoint_at(double t) const {
  std::size_t found = 0;
  for (std::size_t i = 0; i < checkpoints.size(); ++i)
    if (checkpoints[i].t <= t) found = i;
  return found;
}

std::uint64_t checksum_of_tables(const ModelProgram& program) {
  ByteWriter writer;
  const auto add = [&](const Table& table) {
    for (const double x : table.x()) {
      writer(x);
      writer(table.value(x));
    }
    writer(static_cast<std::uint8_t>(table.between()));
  };
  for (const Table& table : program.tables) add(table);
  for (const TableInput& input : program.step_inputs) add(input.table);
  if (program.model.has_world()) {
    for (const MeshDescription& mesh : program.model.world->meshes) {
      if (mesh.corners.empty()) continue;  // its points stand in the text
      writer(mesh.corners);
      writer(mesh.triangles);
    }
  }
  return checksum(writer.bytes());
}

}  // namespace continuo::model
