// The bodies of a world in a picture: spheres and polyhedra with light on them, discs with a mark that shows how they
// turn, polygons, walls, springs and joints.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <apps/continuo/pictures/ground_pictures.hpp>
#include <apps/continuo/pictures/picture_parts.hpp>

#include <continuo/live/audience.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::app {

class BodyPictures {
 public:
  explicit BodyPictures(const worlds::WorldRun& world);

  /// So that they are within the frame wherever they go.
  void take(const live::Bodies& bodies, PictureFrame& frame);
  /// Behind all that `take` has seen.
  void take_meshes(PictureFrame& frame) const;
  /// In the background, what does not move; `draw` draws ground once more where it is before a body.
  void draw_walls(const PictureFrame& frame, PictureParts& parts) const;
  void draw_meshes(const PictureFrame& frame, PictureParts& parts) const;
  void draw(const live::Bodies& bodies, PictureParts& parts) const;

 private:
  worlds::Point place(const live::Bodies& bodies, std::size_t i) const;
  Flat flat(const worlds::Point& p) const;
  double radius_of(std::size_t i) const;
  worlds::Point turned_by(const live::Bodies& bodies, std::size_t i, const worlds::Point& v) const;
  worlds::Point placed(const live::Bodies& bodies, std::size_t body, const worlds::Point& local) const;
  std::uint32_t color_of(std::size_t i) const;
  void draw_springs(const live::Bodies& bodies, PictureParts& parts) const;
  void draw_joints(const live::Bodies& bodies, PictureParts& parts) const;
  void draw_polygons(const live::Bodies& bodies, PictureParts& parts) const;
  std::string polyhedron(const live::Bodies& bodies, std::size_t i) const;
  std::string sphere(const live::Bodies& bodies, std::size_t i) const;
  void draw_discs(const live::Bodies& bodies, PictureParts& parts) const;
  void draw_in_space(const live::Bodies& bodies, PictureParts& parts) const;
  std::vector<Flat> wall_in_plane(const worlds::WallShape& wall, const PictureFrame& frame) const;
  std::vector<Flat> wall_in_space(const worlds::WallShape& wall) const;
  void draw_chain(const worlds::StaticMeshShape& chain, const PictureFrame& frame, PictureParts& parts) const;

  int dimension_;
  std::vector<worlds::BodyShape> shapes_;
  std::vector<worlds::WallShape> walls_;
  std::vector<worlds::StaticMeshShape> meshes_;
  std::vector<worlds::SpringShape> springs_;
  std::vector<worlds::BodyForm> forms_;
  std::vector<worlds::JointShape> joints_;
  GroundPictures ground_;        // of meshes, in space
  worlds::Point lower_, upper_;  // that bodies reach
};

}  // namespace continuo::app
