// SPDX-License-Identifier: Apache-2.0
// Printed, written and displayed things: posters, books, screens.
#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "tools/simulator/rendering/texture_paint.hpp"

namespace rds::simulator::paint {
namespace {

void headline(cv::Mat& image, const std::string& text, cv::Point at, double scale, const cv::Scalar& color) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_DUPLEX, scale, color,
              std::max(1, static_cast<int>(scale * 2)), cv::LINE_AA);
}

cv::Point anywhere(Random& random, const cv::Mat& image) {
  return {random.integer(image.cols), random.integer(image.rows)};
}

void landscape(cv::Mat& image, Random& random) {
  for (int y = 0; y < image.rows; ++y)
    cv::line(image, {0, y}, {image.cols, y}, cv::Scalar(235 - y * 0.2, 190 + y * 0.1, 120 + y * 0.25));
  cv::circle(image, {90 + random.integer(300), 100}, 38, cv::Scalar(120, 220, 255), -1, cv::LINE_AA);
  for (int layer = 0; layer < 4; ++layer) {
    std::vector<cv::Point> ridge{{0, image.rows}};
    for (int x = 0; x <= image.cols + 40; x += 32)
      ridge.emplace_back(x, 170 + layer * 75 + random.integer(80));
    ridge.emplace_back(image.cols + 40, image.rows);
    cv::fillPoly(image, std::vector{ridge},
                 cv::Scalar(110 - 22 * layer, 90 + 12 * layer, 60 + random.integer(60)), cv::LINE_AA);
  }
  for (int i = 0; i < 26; ++i) {
    const cv::Point p(random.integer(image.cols), 330 + random.integer(160));
    const std::array tree{p + cv::Point(0, -50), p + cv::Point(16, 8), p + cv::Point(-16, 8)};
    cv::fillConvexPoly(image, tree.data(), 3, cv::Scalar(35, 50 + random.integer(60), 25), cv::LINE_AA);
  }
}

void geometry(cv::Mat& image, Random& random) {
  image.setTo(cv::Scalar(205, 225, 235));
  for (int i = 0; i < 24; ++i) {
    const cv::Point a = anywhere(random, image);
    const cv::Point b = a + cv::Point(random.integer(180) - 60, random.integer(180) - 60);
    if (i % 3 == 0) cv::circle(image, a, 15 + random.integer(70), vivid(random, 20, 230), -1, cv::LINE_AA);
    if (i % 3 == 1) cv::rectangle(image, a, b, vivid(random, 20, 230), -1);
    if (i % 3 == 2) cv::line(image, a, b, cv::Scalar(20, 20, 25), 4 + random.integer(12), cv::LINE_AA);
  }
}

}  // namespace

std::string word(Random& random, int letters) {
  std::string text;
  for (int i = 0; i < letters; ++i) text += static_cast<char>('A' + random.integer(26));
  return text;
}

void text_block(cv::Mat& image, cv::Rect area, int line_px, const cv::Scalar& color, Random& random) {
  for (int y = area.y + line_px; y < area.br().y; y += line_px * 3 / 2) {
    int x = area.x;
    const int end = area.br().x - random.integer(std::max(1, area.width / 4));
    while (x < end) {
      const int width = std::min(line_px + random.integer(line_px * 4), end - x);
      if (line_px >= 12)
        cv::putText(image, word(random, std::max(1, width / line_px)), {x, y}, cv::FONT_HERSHEY_SIMPLEX,
                    line_px / 24.0, color, 1 + line_px / 14, cv::LINE_AA);
      else
        cv::rectangle(image, cv::Rect(x, y - line_px / 2, std::max(1, width), std::max(1, line_px / 2)),
                      color, -1);
      x += width + line_px;
    }
  }
}

cv::Mat picture(Random& random) {
  cv::Mat image(512, 512, CV_8UC3);
  if (random.chance(0.5))
    landscape(image, random);
  else
    geometry(image, random);
  return image;
}

cv::Mat poster(Random& random) {
  cv::Mat image(512, 512, CV_8UC3, random.chance(0.5) ? cv::Scalar(235, 240, 242) : vivid(random, 60, 235));
  headline(image, word(random, 6), {26, 84}, 2.6, cv::Scalar(30, 25, 60));
  cv::Mat inner = image(cv::Rect(26, 110, 460, 230));
  geometry(inner, random);
  text_block(image, {26, 350, 210, 140}, 13, cv::Scalar(45, 40, 40), random);
  text_block(image, {270, 350, 210, 90}, 8, cv::Scalar(70, 60, 60), random);
  cv::circle(image, {430, 462}, 34, vivid(random), -1, cv::LINE_AA);
  return image;
}

cv::Mat whiteboard(Random& random) {
  cv::Mat image = speckled(random, {1024, 512}, cv::Scalar(232, 232, 228), 3, 2);
  const std::array<cv::Scalar, 4> pens{cv::Scalar(160, 60, 30), cv::Scalar(40, 40, 190),
                                       cv::Scalar(50, 120, 40), cv::Scalar(35, 35, 35)};
  const auto pen = [&] { return pens[static_cast<std::size_t>(random.integer(4))]; };
  for (int i = 0; i < 7; ++i)
    cv::putText(image, word(random, 3 + random.integer(4)) + " = " + word(random, 3),
                {30 + random.integer(120), 70 + i * 62}, cv::FONT_HERSHEY_SCRIPT_SIMPLEX, 1.5, pen(), 3,
                cv::LINE_AA);
  for (int i = 0; i < 9; ++i) {
    const cv::Point a(480 + random.integer(420), 50 + random.integer(380));
    const cv::Point b = a + cv::Point(50 + random.integer(60), 35 + random.integer(40));
    cv::rectangle(image, a, b, pen(), 4);
    cv::arrowedLine(image, b, {480 + random.integer(480), 50 + random.integer(420)}, pen(), 3, cv::LINE_AA);
  }
  return image;
}

cv::Mat book_spines(Random& random) {
  cv::Mat image(512, 1024, CV_8UC3);
  for (int i = 0; i < 16; ++i) {
    cv::Mat spine(64, 512, CV_8UC3, vivid(random, 25, 200) * random.uniform(0.6, 1.1));
    const cv::Scalar ink = random.chance(0.6) ? cv::Scalar(225, 235, 240) : cv::Scalar(40, 190, 225);
    headline(spine, word(random, 5 + random.integer(4)), {60 + random.integer(60), 44}, 1.2, ink);
    cv::rectangle(spine, cv::Rect(14, 0, 10, 64), ink, -1);
    cv::rectangle(spine, cv::Rect(420, 0, 6 + random.integer(50), 64), vivid(random), -1);
    cv::rectangle(spine, cv::Rect(0, 0, 512, 64), cv::Scalar(25, 25, 25), 3);
    cv::rotate(spine, spine, cv::ROTATE_90_CLOCKWISE);
    spine.copyTo(image(cv::Rect(i * 64, 0, 64, 512)));
  }
  return image;
}

cv::Mat cardboard(Random& random) {
  cv::Mat image = speckled(random, {512, 512}, cv::Scalar(96, 140, 180), 8, 6);
  cv::rectangle(image, cv::Rect(0, 226, 512, 60), cv::Scalar(130, 175, 205), -1);
  headline(image, word(random, 4), {40, 130}, 3.0, cv::Scalar(40, 45, 60));
  cv::rectangle(image, cv::Rect(270, 320, 190, 140), cv::Scalar(225, 230, 232), -1);
  text_block(image, {282, 328, 170, 80}, 12, cv::Scalar(30, 30, 30), random);
  for (int x = 285; x < 445; x += 4 + random.integer(8))
    cv::line(image, {x, 412}, {x, 450}, cv::Scalar(20, 20, 20), 1 + random.integer(4));
  cv::arrowedLine(image, {90, 450}, {90, 330}, cv::Scalar(40, 45, 60), 12, cv::LINE_AA, 0, 0.4);
  cv::rectangle(image, cv::Rect(0, 0, 512, 512), cv::Scalar(70, 105, 140), 8);
  return image;
}

cv::Mat screen(Random& random) {
  const bool dark = random.chance(0.5);
  cv::Mat image(512, 1024, CV_8UC3, dark ? cv::Scalar(48, 38, 34) : cv::Scalar(225, 220, 215));
  const cv::Scalar ink = dark ? cv::Scalar(200, 210, 190) : cv::Scalar(60, 50, 50);
  cv::rectangle(image, cv::Rect(0, 0, 1024, 34), dark ? cv::Scalar(90, 70, 60) : cv::Scalar(205, 150, 80),
                -1);
  cv::rectangle(image, cv::Rect(0, 34, 200, 478), dark ? cv::Scalar(62, 50, 46) : cv::Scalar(240, 235, 230),
                -1);
  text_block(image, {16, 50, 170, 440}, 13, ink, random);
  for (int i = 0; i < 15; ++i)
    text_block(image, {230 + 24 * random.integer(4), 44 + i * 30, 380, 24}, 14,
               vivid(random, dark ? 120 : 30, dark ? 255 : 170), random);
  cv::Mat plot = image(cv::Rect(690, 60, 310, 200));
  if (random.chance(0.6))
    landscape(plot, random);
  else
    geometry(plot, random);
  text_block(image, {690, 280, 310, 220}, 12, ink, random);
  return image;
}

cv::Mat keyboard(Random& random) {
  cv::Mat image(128, 512, CV_8UC3, cv::Scalar(45, 43, 42));
  for (int row = 0; row < 5; ++row)
    for (int x = 6 + row * 5; x < 500; x += 28) {
      cv::rectangle(image, cv::Rect(x, 6 + row * 24, 23, 19), cv::Scalar(85, 82, 80), -1);
      headline(image, word(random, 1), {x + 5, 20 + row * 24}, 0.4, cv::Scalar(220, 220, 220));
    }
  return image;
}

cv::Mat bottle_label(Random& random, const cv::Scalar& glass) {
  cv::Mat image = speckled(random, {256, 256}, glass, 8, 3);
  cv::rectangle(image, cv::Rect(0, 120, 256, 90), vivid(random, 60, 240), -1);
  headline(image, word(random, 5), {20, 180}, 1.6, cv::Scalar(250, 250, 250));
  cv::rectangle(image, cv::Rect(0, 126, 256, 6), cv::Scalar(250, 250, 250), -1);
  cv::rectangle(image, cv::Rect(60, 0, 14, 118), glass * 1.7 + cv::Scalar(40, 40, 40), -1);
  return image;
}

cv::Mat window_view(Random& random) {
  cv::Mat image(512, 512, CV_8UC3);
  landscape(image, random);
  image = image * 0.55 + cv::Scalar(110, 105, 100);
  for (int i = 0; i < 5; ++i) {
    const cv::Rect house(i * 105 + random.integer(30), 260 + random.integer(60), 80, 240);
    cv::rectangle(image, house, vivid(random, 120, 220), -1);
    for (int y = house.y + 12; y < 500; y += 34)
      for (int x = house.x + 10; x < house.x + 70; x += 24)
        cv::rectangle(image, cv::Rect(x, y, 13, 19), cv::Scalar(120, 100, 90), -1);
  }
  return image;
}

cv::Mat clock_face() {
  cv::Mat image(256, 256, CV_8UC3, cv::Scalar(40, 40, 45));
  cv::circle(image, {128, 128}, 116, cv::Scalar(238, 240, 240), -1, cv::LINE_AA);
  for (int hour = 1; hour <= 12; ++hour) {
    const double a = hour * 0.5236;
    headline(image, std::to_string(hour),
             {static_cast<int>(114 + 90 * std::sin(a)), static_cast<int>(140 - 90 * std::cos(a))}, 0.9,
             cv::Scalar(25, 25, 25));
  }
  cv::line(image, {128, 128}, {168, 84}, cv::Scalar(20, 20, 20), 9, cv::LINE_AA);
  cv::line(image, {128, 128}, {66, 96}, cv::Scalar(20, 20, 20), 5, cv::LINE_AA);
  return image;
}

cv::Mat cover(Random& random) {
  cv::Mat image(256, 256, CV_8UC3, vivid(random, 50, 225));
  headline(image, word(random, 5), {14, 58}, 1.9, cv::Scalar(245, 245, 245));
  cv::Mat inner = image(cv::Rect(24, 78, 208, 120));
  geometry(inner, random);
  text_block(image, {24, 204, 200, 40}, 9, cv::Scalar(245, 245, 245), random);
  return image;
}

}  // namespace rds::simulator::paint
