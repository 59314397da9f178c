// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/person.hpp"

#include <array>

#include "tools/simulator/world/lighting.hpp"

namespace rds::simulator {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

/// Radius of a limb at share t of its length, 0 at the root, 1 at the end.
struct Girth {
  float t;
  float radius;
};

/// Skin or cloth around a limb from share `from` (towards the end) up to the root.
void add_limb(Mesh& mesh, const Limb& limb, std::span<const Girth> profile, float scale, float from,
              Surface surface) {
  const float upper = (limb.middle - limb.root).norm();
  const float lower = (limb.end - limb.middle).norm();
  const float knee = upper / (upper + lower);
  const Vector3f up_high = (limb.root - limb.middle).normalized();
  const Vector3f up_low = (limb.middle - limb.end).normalized();
  const auto radius_at = [&](float t) {
    std::size_t i = 0;
    while (i + 2 < profile.size() && profile[i + 1].t < t) ++i;
    const float s = std::clamp((t - profile[i].t) / (profile[i + 1].t - profile[i].t), 0.0F, 1.0F);
    return profile[i].radius + s * (profile[i + 1].radius - profile[i].radius);
  };
  std::vector<Ring> rings;
  constexpr int kRings = 14;
  for (int k = kRings; k >= 0; --k) {
    const float t = from * static_cast<float>(k) / kRings;
    const float bend = std::clamp((t - knee) / 0.16F + 0.5F, 0.0F, 1.0F);  // 0 upper part, 1 lower part
    const Vector3f center =
        t <= knee ? Vector3f(limb.root + (limb.middle - limb.root) * (t / knee))
                  : Vector3f(limb.middle + (limb.end - limb.middle) * ((t - knee) / (1 - knee)));
    const Vector3f up = (up_high * (1 - bend) + up_low * bend).normalized();
    Vector3f front = limb.upper_front * (1 - bend) + limb.lower_front * bend;
    front = (front - up * up.dot(front)).normalized();
    const float r = radius_at(t) * scale;
    rings.push_back({center, front.cross(up) * r, front * r, t, 2});
  }
  add_loft(mesh, rings, 14, surface);
}

/// One cross-section of the trunk at a height above the pelvis, as shares of the body's height.
struct Section {
  float z;
  float half_width;
  float half_depth;
  float forward;
};

void add_trunk(Mesh& mesh, const Skeleton& s, const BodyShape& body, std::span<const Section> sections,
               Surface surface) {
  const float h = body.height;
  std::vector<Ring> rings;
  const float low = sections.front().z;
  const float high = sections.back().z;
  for (const auto& section : sections) {
    const float t = std::clamp(section.z / 0.275F, 0.0F, 1.0F);
    const Eigen::Quaternionf turn =
        Eigen::Quaternionf(s.pelvis_axes).slerp(t, Eigen::Quaternionf(s.chest_axes));
    const Matrix3f axes = turn.toRotationMatrix();
    const Vector3f center =
        s.pelvis + (s.chest - s.pelvis) * (section.z / 0.275F) + axes.col(0) * (section.forward * h);
    const float widen = section.z > 0.2F && section.z < 0.31F ? body.shoulders : 1.0F;
    const float girth = section.z > 0.3F ? 1.0F : body.girth;
    rings.push_back({center, -axes.col(1) * (section.half_width * h * girth * widen),
                     axes.col(0) * (section.half_depth * h * girth), 1 - (section.z - low) / (high - low),
                     section.z > 0.3F ? 2.0F : 2.5F});
  }
  add_loft(mesh, rings, 24, surface);
}

constexpr std::array<Section, 7> kHips{{{-0.075F, 0.05F, 0.045F, 0},
                                        {-0.06F, 0.085F, 0.06F, 0},
                                        {-0.03F, 0.098F, 0.068F, 0},
                                        {0, 0.1F, 0.07F, 0},
                                        {0.03F, 0.097F, 0.066F, 0},
                                        {0.06F, 0.09F, 0.06F, 0},
                                        {0.075F, 0.085F, 0.057F, 0}}};
constexpr std::array<Section, 12> kShirt{{{-0.012F, 0.101F, 0.072F, 0},
                                          {0.02F, 0.103F, 0.073F, 0},
                                          {0.06F, 0.095F, 0.067F, 0.003F},
                                          {0.1F, 0.09F, 0.064F, 0.004F},
                                          {0.15F, 0.094F, 0.067F, 0.004F},
                                          {0.2F, 0.1F, 0.07F, 0.004F},
                                          {0.235F, 0.105F, 0.07F, 0.002F},
                                          {0.265F, 0.108F, 0.064F, 0},
                                          {0.285F, 0.1F, 0.055F, -0.003F},
                                          {0.302F, 0.075F, 0.047F, -0.005F},
                                          {0.316F, 0.05F, 0.041F, -0.006F},
                                          {0.326F, 0.036F, 0.036F, -0.005F}}};
constexpr std::array<Section, 3> kNeck{
    {{0.295F, 0.033F, 0.034F, -0.004F}, {0.33F, 0.031F, 0.033F, -0.002F}, {0.37F, 0.032F, 0.034F, 0.002F}}};
constexpr std::array<Girth, 6> kLeg{
    {{0, 0.088F}, {0.12F, 0.09F}, {0.45F, 0.066F}, {0.53F, 0.058F}, {0.68F, 0.06F}, {1, 0.042F}}};
constexpr std::array<Girth, 6> kArm{
    {{0, 0.052F}, {0.12F, 0.055F}, {0.48F, 0.043F}, {0.56F, 0.042F}, {0.68F, 0.041F}, {1, 0.029F}}};

void add_head(Mesh& mesh, const Skeleton& s, const PersonLook& look, std::uint16_t object) {
  const float h = look.body.height / 1.75F;
  const auto axes = [&](float forward, float side, float up) {
    return Matrix3f(s.head_axes * Vector3f(forward * h, side * h, up * h).asDiagonal());
  };
  const auto at = [&](float forward, float side, float up) {
    return Vector3f(s.head + s.head_axes * Vector3f(forward * h, side * h, up * h));
  };
  add_ellipsoid(mesh, at(0, 0, 0), axes(0.101F, 0.079F, 0.124F), 24, {look.head, object});
  add_ellipsoid(mesh, at(0.096F, 0, -0.012F), axes(0.019F, 0.013F, 0.026F), 8, {look.skin, object});
  for (const float side : {-0.079F, 0.079F})
    add_ellipsoid(mesh, at(-0.005F, side, -0.01F), axes(0.02F, 0.011F, 0.033F), 8, {look.skin, object});
  add_ellipsoid(mesh, at(-0.022F, 0, 0.032F), axes(0.094F, 0.087F, 0.108F), 20, {look.hair, object});
  if (look.long_hair) {
    add_ellipsoid(mesh, at(-0.058F, 0, -0.075F), axes(0.055F, 0.09F, 0.15F), 16, {look.hair, object});
    for (const float side : {-0.074F, 0.074F})
      add_ellipsoid(mesh, at(-0.012F, side, -0.06F), axes(0.042F, 0.022F, 0.12F), 12, {look.hair, object});
  }
}

void add_arm(Mesh& mesh, const Limb& arm, const PersonLook& look, std::uint16_t object) {
  const float scale = look.body.height / 1.75F * std::sqrt(look.body.girth);
  const Vector3f along = (arm.end - arm.middle).normalized();
  add_limb(mesh, arm, kArm, scale, 1, {look.skin, object});
  add_limb(mesh, arm, kArm, scale * 1.18F, look.sleeve, {look.sleeves, object});
  add_ellipsoid(mesh, arm.root + (arm.middle - arm.root) * 0.04F, Matrix3f::Identity() * (0.0605F * scale),
                14, {look.sleeves, object});
  Matrix3f hand;
  hand.col(0) = arm.lower_front * (0.035F * scale);
  hand.col(2) = -along * (0.088F * scale);
  hand.col(1) = hand.col(2).cross(hand.col(0)).normalized() * (0.02F * scale);
  add_ellipsoid(mesh, arm.end + along * (0.065F * scale), hand, 10, {look.skin, object});
  const Vector3f thumb = (along + arm.lower_front).normalized();
  Matrix3f thumb_axes;
  thumb_axes.col(2) = thumb * (0.034F * scale);
  thumb_axes.col(1) = hand.col(1).normalized() * (0.012F * scale);
  thumb_axes.col(0) = thumb_axes.col(1).cross(thumb_axes.col(2)).normalized() * (0.013F * scale);
  add_ellipsoid(mesh, arm.end + along * (0.045F * scale) + arm.lower_front * (0.03F * scale), thumb_axes, 8,
                {look.skin, object});
}

void add_leg(Mesh& mesh, const Limb& leg, const Vector3f& toe, const PersonLook& look, std::uint16_t object) {
  const float scale = look.body.height / 1.75F * std::sqrt(look.body.girth);
  if (look.trouser_leg < 1) add_limb(mesh, leg, kLeg, scale * 0.9F, 1, {look.skin, object});
  add_limb(mesh, leg, kLeg, scale * (look.trouser_leg < 1 ? 1.12F : 1.05F), look.trouser_leg,
           {look.trousers, object});
  const float h = look.body.height;
  Matrix3f shoe;
  const Vector3f left = Vector3f::UnitZ().cross(toe).normalized();
  shoe.col(0) = toe * (0.082F * h);
  shoe.col(1) = left * (0.029F * h);
  shoe.col(2) = toe.cross(left) * (0.027F * h);
  add_ellipsoid(mesh, leg.end + toe * (0.036F * h) - shoe.col(2) * 0.62F, shoe, 14, {look.shoes, object});
}

}  // namespace

void build_person(const PersonLook& look, const Motion& motion, std::uint16_t object,
                  std::span<const Lamp> lamps, Mesh& mesh) {
  mesh.vertices.clear();
  mesh.triangles.clear();
  const Skeleton s = pose_skeleton(look.body, motion);
  add_trunk(mesh, s, look.body, kHips, {look.trousers, object});
  add_trunk(mesh, s, look.body, kNeck, {look.skin, object});
  add_trunk(mesh, s, look.body, kShirt, {look.shirt, object});
  add_head(mesh, s, look, object);
  for (std::size_t i = 0; i < 2; ++i) {
    add_arm(mesh, s.arms[i], look, object);
    add_leg(mesh, s.legs[i], s.toes[i], look, object);
  }
  for (auto& vertex : mesh.vertices) vertex.light = light_at(vertex.position, vertex.normal, lamps);
}

}  // namespace rds::simulator
