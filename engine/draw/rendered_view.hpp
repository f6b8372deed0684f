#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/draw/picture.hpp"

namespace sluice {

/// From where a scene of space is looked at: by parallel rays, from z up before z down, y on top.
struct Camera {
  double azimuth = 0.44;    ///< rad, from straight ahead to the side of greater x
  double elevation = 0.38;  ///< rad, from level to above
  friend bool operator==(const Camera&, const Camera&) = default;
};

/// A picture of space as it is seen from one side.
struct RenderedView {
  PictureView plane;  ///< what becomes of a place once it is in the picture
  Camera camera;
  BoxN<3> room;  ///< nothing outside it is shown, m
};

/// The view that a whole room fits into.
[[nodiscard]] RenderedView view_of_room(const BoxN<3>& room, const Camera& camera);

/// Draws a scene of space: tank and obstacles by the first surface that a ray meets, particles as
/// balls, in the light of one lamp, and darker where something lies before them. The solids are
/// looked at once for all frames.
class RenderedScene {
 public:
  /// Both are copied. A tank is seen open from the side of the camera.
  RenderedScene(const Scene& scene, const RenderedView& how);

  /// The scene with the particles of a frame and the gate as it is then. Particles outside the room
  /// or not finite are left out.
  [[nodiscard]] Picture picture(const Snapshot& frame) const;

 private:
  /// What a pixel shows: how far from the camera, what and in which light.
  struct Seen {
    float depth;  ///< m along the ray; infinite where there is nothing
    float light;  ///< 0 to 1
    float share;  ///< of the scale of values
    Matter matter;
  };
  /// The part of a ray that is within the room, by its depth; nothing where it passes by.
  struct Ray {
    Vec3 origin;
    double enter, leave;
  };

  [[nodiscard]] Ray ray(int column, int row) const;
  /// Calls back with column, row and number of each pixel that a box may be seen in.
  template <class Visit>
  void for_pixels(const BoxN<3>& box, const Visit& visit) const;
  void look_at_tank();
  void look_at(const Shape& shape);
  void look_at_gate(std::vector<Seen>& seen, double time) const;
  void add_ball(std::vector<Seen>& seen, const Vec3& place, double share) const;
  [[nodiscard]] double light_on(const Vec3& normal) const;
  [[nodiscard]] double shadow(const std::vector<Seen>& seen, int column, int row) const;

  Scene scene_;
  RenderedView how_;
  Vec3 right_, up_, towards_;  ///< of the picture: unit vectors, the last to the camera
  double scale_;               ///< pixels per metre
  Picture blank_;
  std::vector<Seen> solids_;
};

}  // namespace sluice
