// Any bytes as a Wavefront OBJ file: refused with a place, or a mesh of proper triangles, in time that no file makes
// long.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <continuo/shapes/mesh_check.hpp>
#include <continuo/shapes/wavefront.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mesh = continuo::parse_wavefront(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.obj");
  if (mesh && !continuo::check(*mesh)) std::abort();
  if (!mesh && (mesh.status().message.empty() || !mesh.status().place.starts_with("fuzz.obj"))) std::abort();
  return 0;
}
