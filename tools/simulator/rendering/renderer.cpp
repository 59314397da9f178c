// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::simulator {
namespace {

/// Everything a sample's colour depends on.
struct ShadingContext {
  const Appearance& appearance;
  std::span<const Shadow> shadows;
  Eigen::Matrix3f world_from_ray;
  Eigen::Vector3f eye;
  float inverse_fx;
  float inverse_fy;
};

float shadow_at(const Eigen::Vector2f& point, std::span<const Shadow> shadows) {
  float light = 1;
  for (const auto& shadow : shadows) {
    const float square = (point - shadow.center).squaredNorm() / (shadow.radius * shadow.radius);
    if (square < 1) light *= 1 - shadow.strength * (1 - square) * (1 - square);
  }
  return light;
}

/// Length of a pixel's footprint in texture repetitions: mean of its two sides.
float footprint(const VisibleTriangle& t, float u, float v, float inverse_w, const ShadingContext& context) {
  const auto side = [&](int axis, float inverse_f) {
    const float du = (t.u_over_z[axis] - u * t.inverse_z[axis]) * inverse_w * inverse_f;
    const float dv = (t.v_over_z[axis] - v * t.inverse_z[axis]) * inverse_w * inverse_f;
    return std::sqrt(du * du + dv * dv);
  };
  return 0.5F * (side(0, context.inverse_fx) + side(1, context.inverse_fy));
}

Eigen::Array3f shade(const VisibleTriangle& t, const Eigen::Vector3f& ray, const ShadingContext& context) {
  const float inverse_w = 1 / t.inverse_z.dot(ray);
  const float u = t.u_over_z.dot(ray) * inverse_w;
  const float v = t.v_over_z.dot(ray) * inverse_w;
  const Material& material = context.appearance.materials[t.material];
  Eigen::Array3f light = (t.light_over_z * ray).array() * inverse_w;
  if (material.takes_shadows && !context.shadows.empty()) {
    const Eigen::Vector3f point = context.eye + context.world_from_ray * ray * inverse_w;
    light *= shadow_at(point.head<2>(), context.shadows);
  }
  const auto& texture = context.appearance.textures[material.texture];
  return texture.sample(u, v, footprint(t, u, v, inverse_w, context)) * material.tint * light.max(0.0F);
}

/// The four samples of a pixel, and which of their triangles stands for the pixel: the one with most samples,
/// then the nearest.
struct Pixel {
  std::array<std::uint32_t, 4> ids{};
  std::uint32_t main = 0;
};

Pixel gather(const Rasterizer& rasterizer, int x, int y, const Eigen::Vector3f& ray) {
  Pixel pixel{{rasterizer.at(2 * x, 2 * y), rasterizer.at(2 * x + 1, 2 * y), rasterizer.at(2 * x, 2 * y + 1),
               rasterizer.at(2 * x + 1, 2 * y + 1)},
              0};
  pixel.main = pixel.ids[0];
  if (pixel.ids[1] == pixel.main && pixel.ids[2] == pixel.main && pixel.ids[3] == pixel.main) return pixel;
  auto best_count = 0;
  float best_w = 0;
  for (const auto id : pixel.ids) {
    if (id == 0) continue;
    const auto count = static_cast<int>(std::count(pixel.ids.begin(), pixel.ids.end(), id));
    const float w = rasterizer.triangles()[id - 1].inverse_z.dot(ray);
    if (w <= 0 || count < best_count || (count == best_count && w <= best_w)) continue;
    best_count = count;
    best_w = w;
    pixel.main = id;
  }
  return pixel;
}

}  // namespace

Renderer::Renderer(const geometry::CameraModel& camera) : lens_(camera), rasterizer_(lens_.ideal()) {}

void Renderer::render(std::span<const Mesh* const> meshes, const Appearance& appearance,
                      std::span<const Shadow> shadows, const geometry::Pose& world_from_camera,
                      Rendering& out) {
  rasterizer_.clear();
  const geometry::Pose camera_from_world = world_from_camera.inverse();
  for (const Mesh* mesh : meshes) rasterizer_.draw(*mesh, camera_from_world);
  const cv::Size size(lens_.ideal().width, lens_.ideal().height);
  out.color.create(size, CV_32FC3);
  out.depth.create(size, CV_32FC1);
  out.object.create(size, CV_16UC1);
  out.cosine.create(size, CV_32FC1);
  out.infrared.create(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) shade_row(y, appearance, shadows, world_from_camera, out);
  lens_.distort(out.color, cv::INTER_LINEAR);
  for (cv::Mat* picture : {&out.depth, &out.object, &out.cosine, &out.infrared})
    lens_.distort(*picture, cv::INTER_NEAREST);
}

void Renderer::shade_row(int y, const Appearance& appearance, std::span<const Shadow> shadows,
                         const geometry::Pose& world_from_camera, Rendering& out) const {
  const ShadingContext context{appearance,
                               shadows,
                               world_from_camera.linear().cast<float>(),
                               world_from_camera.translation().cast<float>(),
                               1 / static_cast<float>(lens_.ideal().fx),
                               1 / static_cast<float>(lens_.ideal().fy)};
  const auto& triangles = rasterizer_.triangles();
  auto* color = out.color.ptr<cv::Vec3f>(y);
  for (int x = 0; x < lens_.ideal().width; ++x) {
    const auto sx = static_cast<float>(2 * x);
    const auto sy = static_cast<float>(2 * y);
    const Eigen::Vector3f ray(rasterizer_.ray_x(sx + 0.5F), rasterizer_.ray_y(sy + 0.5F), 1);
    const Pixel pixel = gather(rasterizer_, x, y, ray);
    out.depth.at<float>(y, x) = 0;
    out.object.at<std::uint16_t>(y, x) = 0;
    color[x] = {0, 0, 0};
    if (pixel.main == 0) continue;
    const VisibleTriangle& main = triangles[pixel.main - 1];
    const float w = main.inverse_z.dot(ray);
    out.depth.at<float>(y, x) = w > 0 ? 1 / w : 0;
    out.object.at<std::uint16_t>(y, x) = main.object;
    out.cosine.at<float>(y, x) = std::abs(w) / (main.inverse_z.norm() * ray.norm());
    out.infrared.at<float>(y, x) = appearance.materials[main.material].infrared;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    for (std::size_t i = 0; i < 4;) {
      // Samples of the same triangle are shaded once, at their middle.
      const std::uint32_t id = pixel.ids[i];
      float px = 0;
      float py = 0;
      float count = 0;
      std::size_t next = 4;
      for (std::size_t k = i; k < 4; ++k) {
        if (pixel.ids[k] == id) {
          px += sx + static_cast<float>(k & 1U);
          py += sy + static_cast<float>(k >> 1U);
          ++count;
        } else if (next == 4 && std::find(pixel.ids.begin(), pixel.ids.begin() + static_cast<long>(k),
                                          pixel.ids[k]) == pixel.ids.begin() + static_cast<long>(k)) {
          next = k;
        }
      }
      if (id != 0)
        sum += count * shade(triangles[id - 1],
                             {rasterizer_.ray_x(px / count), rasterizer_.ray_y(py / count), 1}, context);
      i = next;
    }
    color[x] = {sum[0] / 4, sum[1] / 4, sum[2] / 4};
  }
}

}  // namespace rds::simulator
