// Ground of triangles in pictures of space: behind the bodies that are in front of it, and in front of those behind it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <apps/continuo/pictures/picture_parts.hpp>

#include <continuo/worlds/world_run.hpp>

namespace continuo::app {

class GroundPictures {
 public:
  GroundPictures() = default;
  explicit GroundPictures(const std::vector<worlds::StaticMeshShape>& meshes);

  /// All of it, from the farthest to the nearest.
  void draw(PictureParts& parts) const;
  /// Once more what is between us and a body, which reaches so far from its centre in the picture.
  void draw_before(const worlds::Point& centre, double radius, PictureParts& parts) const;

 private:
  struct Facet {
    std::array<Flat, 3> corners;
    worlds::Point normal;  // towards us
    double offset;         // of its plane: normal . x
    double nearness;
    std::uint32_t color;
    bool has_edges;
  };
  void add(const worlds::StaticMeshShape& mesh, std::size_t facet);
  void sort_into_cells();
  std::size_t cell_of(double place, double low, double size) const;
  void draw(const std::vector<std::uint32_t>& facets, PictureParts& parts) const;

  std::vector<Facet> facets_;  // from the farthest to the nearest
  std::size_t cells_along_ = 0;
  PictureFrame frame_;
  std::vector<std::vector<std::uint32_t>> cells_;  // of the picture, row by row: the facets that may be seen in each
};

}  // namespace continuo::app
