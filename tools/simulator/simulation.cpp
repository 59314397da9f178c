// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/simulation.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tools/simulator/building/floor.hpp"
#include "tools/simulator/rendering/silhouette.hpp"
#include "tools/simulator/robot_path.hpp"
#include "tools/simulator/world/room.hpp"
#include "tools/simulator/world/visibility.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kPeopleStream = 100;
constexpr double kPersonReach = 0.7;      // of arms and legs, from the middle of a person [m]
constexpr double kLeastSeen = 1.0 / 768;  // of the picture, that an object must fill (400 px of 640×480)

Eigen::Vector3d on_floor(const Motion& motion) {
  return {motion.position.x(), motion.position.y(), 0};
}

std::vector<Shadow> shadows_of(const PersonLook& look, const Motion& motion) {
  const Skeleton s = pose_skeleton(look.body, motion);
  std::vector<Shadow> shadows{{s.pelvis.head<2>(), 0.55F, 0.28F}};
  for (const auto& leg : s.legs) {
    const float lifted = std::max(0.0F, leg.end.z() - 0.09F);
    shadows.push_back({leg.end.head<2>(), 0.2F + lifted, 0.5F / (1 + 4 * lifted)});
  }
  return shadows;
}

Scene make_scene(const SimulationOptions& options) {
  if (options.world == World::kRoom) return make_room(options.seed);
  return make_floor(options.seed, options.rooms, options.day);
}

WalkPlanner::CameraAt make_path(const SimulationOptions& options, const Scene& scene) {
  if (options.world == World::kRoom)
    return [path = CameraPath(options.path, options.seconds, options.seed)](double t) {
      return path.world_from_camera(t);
    };
  return [path = RobotPath(scene, options.seconds, options.seed + static_cast<std::uint64_t>(options.day))](
             double t) { return path.world_from_camera(t); };
}

std::string motion_name(const Motion& motion, double turn_rad_s) {
  if (motion.speed > 0.1) return "walk";
  return std::abs(turn_rad_s) > 0.3 ? "turn" : "stand";
}

}  // namespace

geometry::CameraModel camera_of_size(int width, int height) {
  constexpr double kFocalPerWidth = 525.0 / 640;
  const double f = kFocalPerWidth * width;
  return {width, height, f, f, (width - 1) / 2.0, (height - 1) / 2.0, {}};
}

Simulation::Simulation(const SimulationOptions& options)
    : options_(options),
      scene_(make_scene(options)),
      camera_at_(make_path(options, scene_)),
      color_sensor_(options.seed),
      depth_sensor_(options.seed, options.camera.fx, options.depth_units_per_metre) {
  const FloorMap floor(scene_);
  WalkPlanner planner(floor, options_.camera, camera_at_, options_.seconds);
  for (int i = 0; i < options_.people; ++i) {
    Random random(options_.seed, kPeopleStream + static_cast<std::uint64_t>(i));
    Actor actor;
    actor.look = make_person(scene_.appearance, random);
    actor.walk = planner.plan(static_cast<double>(actor.look.walking_speed), random);
    actors_.push_back(std::move(actor));
  }
}

int Simulation::frame_count() const {
  return std::max(1, static_cast<int>(std::lround(options_.seconds * options_.rate_hz)));
}

SimulatedFrame Simulation::frame(int index, Renderer& renderer) const {
  const double t = time_s(index);
  const geometry::Pose pose = camera_at_(t);
  std::vector<Mesh> people(actors_.size());
  const auto visible = visible_rooms(scene_, renderer.ideal_camera(), pose);
  std::vector<const Mesh*> meshes;
  for (const std::size_t room : visible) meshes.push_back(&scene_.rooms[room].mesh);
  std::vector<Shadow> shadows;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const Motion motion = actors_[i].walk.at(t);
    if (!may_be_seen(motion, visible)) continue;
    build_person(actors_[i].look, motion, static_cast<std::uint16_t>(kFirstPerson + i),
                 scene_.rooms[scene_.room_at(on_floor(motion))].lamps, people[i]);
    meshes.push_back(&people[i]);
    const auto own = shadows_of(actors_[i].look, motion);
    shadows.insert(shadows.end(), own.begin(), own.end());
  }
  Rendering rendering;
  renderer.render(meshes, scene_.appearance, shadows, pose, rendering);
  SimulatedFrame out;
  const auto number = static_cast<std::uint64_t>(index);
  out.color = color_sensor_.expose(rendering.color, number, t);
  out.depth = depth_sensor_.measure(rendering, number);
  out.mask = cv::Mat::zeros(rendering.object.size(), CV_8UC1);
  for (int y = 0; y < out.mask.rows; ++y)
    for (int x = 0; x < out.mask.cols; ++x)
      if (const auto object = rendering.object.at<std::uint16_t>(y, x); object >= kFirstPerson)
        out.mask.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(object - kFirstPerson + 1);
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    PersonTruth truth = truth_of(static_cast<int>(i), t, people[i], out.mask, pose);
    if (truth.area > 0) out.people.push_back(std::move(truth));
  }
  observe_objects(rendering, pose, out);
  return out;
}

bool Simulation::may_be_seen(const Motion& motion, const std::vector<std::size_t>& visible) const {
  return std::ranges::any_of(visible, [&](std::size_t room) {
    return scene_.rooms[room].distance(on_floor(motion)) < kPersonReach;
  });
}

PersonTruth Simulation::truth_of(int id, double t, const Mesh& mesh, const cv::Mat& mask,
                                 const geometry::Pose& pose) const {
  const Actor& actor = actors_[static_cast<std::size_t>(id)];
  const Motion motion = actor.walk.at(t);
  PersonTruth truth;
  truth.id = id;
  cv::Mat own;
  cv::compare(mask, id + 1, own, cv::CMP_EQ);
  truth.area = cv::countNonZero(own);
  if (truth.area == 0) return truth;
  truth.box = cv::boundingRect(own);
  const double whole = silhouette_area(mesh, options_.camera, pose.inverse());
  truth.visible_fraction = std::min(1.0, truth.area / std::max(whole, 1.0));
  truth.center_world = {motion.position.x(), motion.position.y(),
                        static_cast<double>(actor.look.body.height) / 2};
  truth.velocity_world.head<2>() = actor.walk.velocity(t);
  truth.distance = (pose.inverse() * truth.center_world).z();
  truth.motion =
      motion_name(motion, (actor.walk.at(t + 0.05).heading_rad - actor.walk.at(t - 0.05).heading_rad) / 0.1);
  return truth;
}

void Simulation::observe_objects(const Rendering& rendering, const geometry::Pose& pose,
                                 SimulatedFrame& out) const {
  const auto seen = visible_objects(rendering.object, rendering.depth);
  const geometry::Pose camera_from_world = pose.inverse();
  for (const auto& object : seen) {
    const bool person = object.object >= kFirstPerson;
    if (!person && scene_.objects[object.object].label.empty()) continue;
    if (object.area < kLeastSeen * options_.camera.width * options_.camera.height) continue;
    if (!person) {
      const auto whole =
          geometry::project(scene_.objects[object.object].box, camera_from_world, options_.camera);
      if (!whole || object.box.area() < 0.4 * whole->area()) continue;  // too little for any detector
    }
    out.visible.push_back(
        {person ? "person" : scene_.objects[object.object].label, object.box, object.depth_m});
  }
}

}  // namespace rds::simulator
