// Any bytes as a snapshot: refused with the place of the error, or restored to a world that saves to the same bytes and
// moves on or refuses with a reason. The checksum at the end is corrected first, or hardly any input would pass it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include <continuo/bodies/snapshot.hpp>

namespace {

using namespace continuo;

void check_refusal(const std::string& error) {
  if (error.substr(0, 5) != "byte ") std::abort();
}

template <class Real, int Dim>
void restore_all(const Bytes& bytes) {
  World<Real, Dim> plain;
  if (const Status status = restore(bytes, plain); !status) return check_refusal(status.message);
  if (snapshot(plain) != snapshot(World<Real, Dim>(plain))) std::abort();

  World<Real, Dim> of_exact;
  ExactMotion<Real, Dim> exact(of_exact, {.most_events = 200, .contact_events = 10});
  if (restore(bytes, of_exact, exact)) {
    if (snapshot(of_exact, exact) != bytes) std::abort();
    (void)exact.advance_to(of_exact.time + Real(0.01));
  }
  World<Real, Dim> of_fast;
  FastMotion<Real, Dim> fast(of_fast, {.contact_events = 10});
  if (restore(bytes, of_fast, fast)) (void)fast.advance();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(data[i]);
  if (size < 8) return 0;
  bytes.resize(size - 8);
  ByteWriter sum;
  sum(checksum(bytes));
  bytes.insert(bytes.end(), sum.bytes().begin(), sum.bytes().end());
  restore_all<double, 3>(bytes);
  restore_all<float, 2>(bytes);
  return 0;
}
