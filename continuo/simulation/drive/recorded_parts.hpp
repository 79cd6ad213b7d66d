// Parts of recordings that are the same for equations and for worlds, as bytes and back: see bytes.hpp for archives.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/bodies/support/blocks.hpp>
#include <continuo/simulation/program/event_names.hpp>
#include <continuo/simulation/recorded_run.hpp>

namespace continuo::model::recorded {

template <class Archive, class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void transfer(Archive& archive, T& value) {
  archive(value);
}
/// A size, of eight bytes on every machine.
template <class Archive>
void transfer_count(Archive& archive, std::size_t& value) {
  auto number = static_cast<std::uint64_t>(value);
  archive(number);
  if constexpr (Archive::reads) value = static_cast<std::size_t>(number);
}
template <class Archive>
void transfer(Archive& archive, std::string& text) {
  std::vector<char> letters(text.begin(), text.end());
  archive(letters);
  if constexpr (Archive::reads) text.assign(letters.begin(), letters.end());
}
template <class Archive>
void transfer(Archive& archive, std::vector<double>& numbers) {
  archive(numbers);
}
template <class Archive>
void transfer(Archive& archive, EventName& name) {
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
  if (!is_there) return value.reset();
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
void transfer(Archive& archive, Overrides& values) {
  std::vector<std::pair<std::string, double>> list(values.begin(), values.end());
  transfer_list(archive, list);
  if constexpr (Archive::reads) values = Overrides(list.begin(), list.end());
}

template <class Archive>
void transfer(Archive& archive, RunHead& head) {
  for (std::string* text : {&head.version, &head.file, &head.text}) transfer(archive, *text);
  archive(head.data), archive(head.decides_size), archive(head.as_written);
  Experiment& e = head.experiment;
  transfer(archive, e.method);
  for (std::optional<double>* number : {&e.rtol, &e.step, &e.from, &e.to, &e.output, &e.max_step})
    transfer(archive, *number);
  std::size_t max_steps = e.max_steps.value_or(0);
  transfer_count(archive, max_steps);
  if constexpr (Archive::reads) e.max_steps = max_steps > 0 ? std::optional(max_steps) : std::nullopt;
  archive(e.output_steps), archive(e.atol), archive(e.keep_rows), archive(e.doubts);
  for (Overrides* values : {&e.rtol_of, &e.atol_of, &e.parameters, &e.initial}) transfer(archive, *values);
}
template <class Archive>
void transfer(Archive& archive, RunEnd& end) {
  Outcome<double>& o = end.outcome;
  archive(o.ending), archive(o.t), archive(o.h), archive(o.error), archive(o.limit_time);
  for (std::string* text : {&o.component, &o.event, &o.hint, &end.stop_text, &end.error}) transfer(archive, *text);
  Statistics& s = end.statistics;
  for (std::size_t* count :
       {&s.steps, &s.rejected, &s.evaluations, &s.jacobians, &s.factorizations, &s.linear_solves, &s.events})
    transfer_count(archive, *count);
  archive(s.seconds);
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

}  // namespace continuo::model::recorded
