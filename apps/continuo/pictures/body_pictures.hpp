// The bodies of a world in a picture: spheres with light on them, discs with a mark that shows how they turn, walls and
// springs.
#pragma once
#include <vector>

#include <apps/continuo/pictures/picture_parts.hpp>

#include <continuo/live/audience.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::app {

class BodyPictures {
 public:
  explicit BodyPictures(const worlds::WorldRun& world);

  /// So that they are within the frame wherever they go.
  void take(const live::Bodies& bodies, PictureFrame& frame);
  /// In the background, what does not move.
  void draw_walls(const PictureFrame& frame, PictureParts& parts) const;
  void draw(const live::Bodies& bodies, PictureParts& parts) const;

 private:
  worlds::Point place(const live::Bodies& bodies, std::size_t i) const;
  Flat flat(const worlds::Point& p) const;
  double radius_of(std::size_t i) const;
  void draw_springs(const live::Bodies& bodies, PictureParts& parts) const;
  void draw_discs(const live::Bodies& bodies, PictureParts& parts) const;
  void draw_spheres(const live::Bodies& bodies, PictureParts& parts) const;
  std::vector<Flat> wall_in_plane(const worlds::WallShape& wall, const PictureFrame& frame) const;
  std::vector<Flat> wall_in_space(const worlds::WallShape& wall) const;

  int dimension_;
  std::vector<worlds::BodyShape> shapes_;
  std::vector<worlds::WallShape> walls_;
  std::vector<worlds::SpringShape> springs_;
  worlds::Point lower_, upper_;  // that bodies reach
};

}  // namespace continuo::app
