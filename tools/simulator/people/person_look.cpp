// SPDX-License-Identifier: Apache-2.0
// Clothes, faces and proportions.
#include <algorithm>
#include <array>

#include <opencv2/imgproc.hpp>

#include "tools/simulator/people/person.hpp"
#include "tools/simulator/rendering/texture_paint.hpp"

namespace rds::simulator {
namespace {

/// Folds of cloth: soft light and dark bands.
void add_folds(cv::Mat& image, Random& random, double strength) {
  const cv::Mat folds = paint::noise(random, image.size(), {5, 9}, 3) * strength;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      for (int c = 0; c < 3; ++c) {
        auto& value = image.at<cv::Vec3b>(y, x)[c];
        value = cv::saturate_cast<uchar>(value * (1 + folds.at<float>(y, x)));
      }
}

void plaid(cv::Mat& image, const cv::Scalar& ink, Random& random) {
  const int step = 48 + random.integer(30);
  cv::Mat lines = image.clone();
  for (int i = 0; i < 512; i += step) {
    cv::rectangle(lines, cv::Rect(i, 0, step / 3, 512), ink, -1);
    cv::rectangle(lines, cv::Rect(0, i, 512, step / 3), ink, -1);
    cv::line(lines, {i + step / 2, 0}, {i + step / 2, 511}, ink * 1.4, 3);
  }
  cv::addWeighted(image, 0.4, lines, 0.6, 0, image);
}

/// Colours as people wear them: mostly muted.
cv::Scalar cloth_color(Random& random) {
  const double gray = random.uniform(35, 200);
  const double strength = random.chance(0.3) ? 0.85 : 0.4;
  return paint::vivid(random, 35, 205) * strength + cv::Scalar::all(gray * (1 - strength));
}

/// Shirt, jumper or jacket: u = 0.25 is the front, v = 0 the collar.
cv::Mat shirt(Random& random, const cv::Scalar& color) {
  cv::Mat image = paint::fabric(random, color, 0.6);
  cv::resize(image, image, {512, 512});
  const cv::Scalar ink = cloth_color(random);
  const int kind = random.integer(5);
  if (kind == 0) plaid(image, ink, random);
  if (kind == 1)
    for (int y = 20; y < 512; y += 60) cv::rectangle(image, cv::Rect(0, y, 512, 22), ink, -1);
  if (kind == 2) {  // print on the chest
    cv::circle(image, {128, 190}, 46, ink, -1, cv::LINE_AA);
    cv::putText(image, paint::word(random, 4), {74, 205}, cv::FONT_HERSHEY_DUPLEX, 1.3,
                cv::Scalar(240, 240, 240), 3, cv::LINE_AA);
  }
  if (kind == 3) {  // open jacket over a light shirt
    cv::rectangle(image, cv::Rect(100, 0, 56, 512), cv::Scalar(215, 220, 225), -1);
    for (int y = 60; y < 500; y += 70)
      cv::circle(image, {128, y}, 5, cv::Scalar(90, 90, 95), -1, cv::LINE_AA);
    for (const int x : {98, 158}) cv::line(image, {x, 0}, {x, 511}, cv::Scalar(40, 40, 40), 5);
    for (const int x : {40, 180}) cv::rectangle(image, cv::Rect(x, 330, 44, 60), cv::Scalar(45, 45, 45), 3);
  }
  if (kind == 4)
    for (int i = 0; i < 90; ++i)
      cv::circle(image, {random.integer(512), random.integer(512)}, 9, ink, -1, cv::LINE_AA);
  cv::rectangle(image, cv::Rect(0, 0, 512, 18), ink * 0.6, -1);
  add_folds(image, random, 0.3);
  return image;
}

cv::Mat sleeve(Random& random, const cv::Scalar& color) {
  cv::Mat image = paint::fabric(random, color, 0.6);
  add_folds(image, random, 0.25);
  return image;
}

cv::Mat strands(Random& random, const cv::Scalar& color) {
  cv::Mat image = paint::speckled(random, {256, 256}, color, 4, 2);
  for (int i = 0; i < 220; ++i) {
    const int x = random.integer(256);
    cv::line(image, {x, 0}, {x + random.integer(40) - 20, 255}, color * random.uniform(0.6, 1.35), 1,
             cv::LINE_AA);
  }
  return image;
}

cv::Mat trousers(Random& random) {
  const std::array<cv::Scalar, 5> colors{cv::Scalar(105, 70, 45), cv::Scalar(60, 45, 40),
                                         cv::Scalar(95, 130, 150), cv::Scalar(55, 55, 58),
                                         cv::Scalar(130, 95, 70)};
  cv::Mat image = paint::fabric(random, colors[static_cast<std::size_t>(random.integer(5))], 0.8);
  cv::resize(image, image, {256, 512});
  cv::line(image, {128, 0}, {128, 511}, cv::Scalar(70, 80, 90), 3);
  add_folds(image, random, 0.32);
  return image;
}

/// Head unrolled: u = 0.5 is the face, v = 0 the top.
cv::Mat head(Random& random, const cv::Scalar& skin, const cv::Scalar& hair, bool beard) {
  cv::Mat image = paint::speckled(random, {512, 512}, skin, 5, 3);
  for (const int side : {-1, 1}) {
    const int x = 256 + side * 34;
    cv::ellipse(image, {x + side * 10, 308}, {22, 20}, 0, 0, 360, skin * 0.9 + cv::Scalar(0, 0, 22), -1,
                cv::LINE_AA);  // cheek
    cv::ellipse(image, {x, 246}, {20, 15}, 0, 0, 360, skin * 0.72, -1, cv::LINE_AA);
    cv::ellipse(image, {x, 247}, {15, 8}, 0, 0, 360, cv::Scalar(235, 238, 240), -1, cv::LINE_AA);
    cv::circle(image, {x, 247}, 8, cv::Scalar(60, 50, 40), -1, cv::LINE_AA);
    cv::circle(image, {x, 247}, 4, cv::Scalar(10, 10, 10), -1, cv::LINE_AA);
    cv::ellipse(image, {x, 228}, {21, 8}, 0, 195, 345, hair * 0.8, 7, cv::LINE_AA);
  }
  cv::ellipse(image, {256, 300}, {16, 8}, 0, 0, 360, skin * 0.72, -1, cv::LINE_AA);
  if (beard) cv::ellipse(image, {256, 390}, {80, 62}, 0, 0, 360, hair * 0.9, -1, cv::LINE_AA);
  cv::ellipse(image, {256, 340}, {27, 9}, 0, 0, 360, cv::Scalar(90, 90, 175), -1, cv::LINE_AA);
  cv::line(image, {231, 340}, {281, 340}, cv::Scalar(50, 45, 100), 3, cv::LINE_AA);
  cv::rectangle(image, cv::Rect(0, 0, 512, 130), hair, -1);
  for (int x = 0; x < 512; ++x)
    if (std::abs(x - 256) > 105) cv::line(image, {x, 100}, {x, std::abs(x - 256) > 150 ? 350 : 260}, hair, 1);
  cv::GaussianBlur(image, image, {5, 5}, 1.2);
  return image;
}

}  // namespace

PersonLook make_person(Appearance& appearance, Random& random) {
  const auto add = [&appearance](const cv::Mat& picture, float infrared) {
    appearance.textures.emplace_back(picture);
    Material material;
    material.texture = appearance.textures.size() - 1;
    material.infrared = infrared;
    appearance.materials.push_back(material);
    return static_cast<std::uint16_t>(appearance.materials.size() - 1);
  };
  const std::array<cv::Scalar, 4> skins{cv::Scalar(165, 190, 230), cv::Scalar(140, 170, 215),
                                        cv::Scalar(95, 130, 180), cv::Scalar(60, 85, 125)};
  const std::array<cv::Scalar, 5> hairs{cv::Scalar(25, 28, 35), cv::Scalar(35, 50, 75),
                                        cv::Scalar(60, 95, 140), cv::Scalar(95, 150, 190),
                                        cv::Scalar(130, 130, 135)};
  const cv::Scalar& skin = skins[static_cast<std::size_t>(random.integer(4))];
  const cv::Scalar& hair = hairs[static_cast<std::size_t>(random.integer(5))];
  PersonLook look;
  look.long_hair = random.chance(0.45);
  const cv::Scalar color = cloth_color(random);
  look.shirt = add(shirt(random, color), 0.95F);
  look.sleeves = add(sleeve(random, color), 0.95F);
  look.trousers = add(trousers(random), 0.9F);
  look.skin = add(paint::speckled(random, {128, 128}, skin, 5, 3), 0.9F);
  look.head = add(head(random, skin, hair, !look.long_hair && random.chance(0.35)), 0.85F);
  look.hair = add(strands(random, hair), 0.5F);
  look.shoes =
      add(paint::speckled(random, {64, 64},
                          random.chance(0.6) ? cv::Scalar(40, 38, 38) : paint::vivid(random, 60, 220), 5, 4),
          0.8F);
  look.body.height =
      static_cast<float>(random.uniform(look.long_hair ? 1.58 : 1.68, look.long_hair ? 1.76 : 1.92));
  look.body.girth = static_cast<float>(random.uniform(0.95, 1.28));
  look.body.shoulders = look.long_hair ? 0.93F : static_cast<float>(random.uniform(1.0, 1.1));
  look.body.arm_swing = static_cast<float>(random.uniform(0.7, 1.2));
  look.sleeve = random.chance(0.6) ? 0.95F : 0.34F;
  look.trouser_leg = random.chance(0.85) ? 0.97F : 0.5F;
  look.walking_speed = static_cast<float>(random.uniform(0.7, 1.1));
  return look;
}

}  // namespace rds::simulator
