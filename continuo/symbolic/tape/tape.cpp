// continuo/symbolic/tape/tape.cpp
// The evaluation for the usual numbers, compiled once. The compiler of tapes is in tape_compile.cpp.
#include <continuo/symbolic/tape/tape_run.hpp>

namespace continuo::model {

template void Tape::prepare(std::span<float>) const;
template void Tape::prepare(std::span<double>) const;
template void Tape::prepare(std::span<long double>) const;
template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>) const;
template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>, const tape::Copies&) const;
template void Tape::evaluate(std::span<float>, std::span<float>) const;
template void Tape::evaluate(std::span<double>, std::span<double>) const;
template void Tape::evaluate(std::span<long double>, std::span<long double>) const;

Tape::Size Tape::size() const {
  const auto count = [](const Program& program) {
    return program.instructions.empty() ? 0 : program.instructions.size() - 1;
  };
  Size size{.prepared = count(preparation_), .single = count(body_) - body_.batches.size()};
  size.batches = body_.batches.size();
  for (const tape::Batch& batch : body_.batches) size.batched += batch.count;
  size.gathered = body_.gathered.size();
  return size;
}

}  // namespace continuo::model
