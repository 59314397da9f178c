// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/texture_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace rds::simulator::paint {
namespace {

cv::Scalar scaled(const cv::Scalar& color, double factor) {
  return color * factor;
}

void add_gray(cv::Mat& image, const cv::Mat& amount) {
  cv::Mat sum;
  cv::Mat three;
  cv::merge(std::array{amount, amount, amount}, three);
  image.convertTo(sum, CV_32FC3);
  sum += three;
  sum.convertTo(image, CV_8UC3);
}

/// Fine ribs of a weave.
void weave(cv::Mat& image, int period, double strength) {
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const bool over = ((x / period) + (y / period)) % 2 == 0;
      auto& p = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) p[c] = cv::saturate_cast<uchar>(p[c] + (over ? strength : -strength));
    }
}

void diamond(cv::Mat& image, cv::Point center, int radius, const cv::Scalar& color) {
  const std::array points{center + cv::Point(0, -radius), center + cv::Point(radius * 2 / 3, 0),
                          center + cv::Point(0, radius), center + cv::Point(-radius * 2 / 3, 0)};
  cv::fillConvexPoly(image, points.data(), 4, color, cv::LINE_AA);
}

}  // namespace

cv::Scalar vivid(Random& random, double low, double high) {
  const double hue = random.uniform(0, 6);
  const double top = random.uniform(0.6, 1.0) * (high - low) + low;
  const double bottom = low + random.uniform(0, 0.35) * (top - low);
  const auto channel = [&](double offset) {
    const double distance = std::abs(std::remainder(hue - offset, 6.0));  // 0 … 3 from this primary colour
    return bottom + (top - bottom) * std::clamp(2 - distance, 0.0, 1.0);
  };
  return {channel(4), channel(2), channel(0)};
}

cv::Mat noise(Random& random, cv::Size size, cv::Size cells, int octaves) {
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC1);
  float weight = 0.6F;
  for (int octave = 0; octave < octaves; ++octave, weight *= 0.55F) {
    cv::Mat lattice(std::min(cells.height << octave, size.height),
                    std::min(cells.width << octave, size.width), CV_32FC1);
    for (int y = 0; y < lattice.rows; ++y)
      for (int x = 0; x < lattice.cols; ++x)
        lattice.at<float>(y, x) = weight * static_cast<float>(random.uniform(-1, 1));
    cv::Mat fine;
    cv::resize(lattice, fine, size, 0, 0, cv::INTER_CUBIC);
    sum += fine;
  }
  return sum;
}

cv::Mat speckled(Random& random, cv::Size size, const cv::Scalar& color, double blotches, double grain) {
  cv::Mat image(size, CV_8UC3, color);
  add_gray(image, noise(random, size, {6, 6}, 4) * blotches +
                      noise(random, size, {size.width / 2, size.height / 2}, 2) * grain);
  return image;
}

cv::Mat wood(Random& random, const cv::Scalar& color, double contrast) {
  const cv::Size size(512, 512);
  cv::Mat image(size, CV_8UC3, color);
  const cv::Mat warp = noise(random, size, {3, 5}, 3);
  const cv::Mat fibre = noise(random, size, {10, 170}, 2);
  cv::Mat rings(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      rings.at<float>(y, x) =
          static_cast<float>(std::sin(y * 0.16 + 9.0 * warp.at<float>(y, x)) * 11 * contrast);
  add_gray(image, rings + fibre * (20 * contrast));
  for (int i = 0; i < 5; ++i) {
    const cv::Point knot(random.integer(512), random.integer(512));
    for (int r = 3; r > 0; --r)
      cv::ellipse(image, knot, cv::Size(5 * r, 2 * r + 1), 0, 0, 360, scaled(color, 0.45 + 0.12 * r), -1,
                  cv::LINE_AA);
  }
  return image;
}

cv::Mat parquet(Random& random, const cv::Scalar& color) {
  const cv::Mat grain = wood(random, color, 0.9);
  cv::Mat image(1024, 1024, CV_8UC3);
  const int plank = 128;
  for (int row = 0; row < 8; ++row) {
    int x = -random.integer(300);
    while (x < image.cols) {
      const int length = 320 + random.integer(190);
      const cv::Rect area = cv::Rect(x, row * plank, length, plank) & cv::Rect(0, 0, image.cols, image.rows);
      const cv::Rect source(
          random.integer(512 - std::min(511, area.width) + 1) % std::max(1, 512 - area.width + 1),
          random.integer(384), area.width, plank);
      cv::Mat piece = grain(source).clone() * random.uniform(0.78, 1.14);
      cv::rectangle(piece, cv::Rect(0, 0, piece.cols, piece.rows), scaled(color, 0.35), 2);
      piece.copyTo(image(area));
      x += length;
    }
  }
  return image;
}

cv::Mat carpet(Random& random) {
  cv::Mat image(1024, 1024, CV_8UC3);
  const std::array<cv::Scalar, 4> palette{vivid(random, 30, 120), vivid(random, 60, 200),
                                          cv::Scalar(190, 215, 225), cv::Scalar(50, 40, 70)};
  image.setTo(palette[0]);
  const auto border = [&image](int inset, int thickness, const cv::Scalar& color) {
    cv::rectangle(image, {inset, inset}, {1023 - inset, 1023 - inset}, color, thickness);
  };
  border(20, 24, palette[3]);
  border(60, 40, palette[1]);
  border(92, 6, palette[2]);
  for (int i = 0; i < 22; ++i)
    for (const int side : {60, 963}) {
      diamond(image, {60 + i * 43, side}, 17, palette[i % 2 == 0 ? 2 : 3]);
      diamond(image, {side, 60 + i * 43}, 17, palette[i % 2 == 0 ? 2 : 3]);
    }
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 7; ++x) {
      const cv::Point c(165 + x * 116, 165 + y * 116);
      const auto pick = [&] { return palette[static_cast<std::size_t>(random.integer(4))]; };
      diamond(image, c, 56, pick());
      cv::circle(image, c, 24, pick(), -1, cv::LINE_AA);
      if (random.chance(0.6)) cv::drawMarker(image, c, pick(), random.integer(5), 26, 6);
      for (const auto& d : {cv::Point(44, 44), cv::Point(-44, 44)})
        cv::rectangle(image, c + d - cv::Point(9, 9), c + d + cv::Point(9, 9), pick(), -1);
    }
  add_gray(image,
           noise(random, image.size(), {8, 8}, 3) * 14.0 + noise(random, image.size(), {512, 512}, 1) * 26.0);
  return image;
}

cv::Mat wallpaper(Random& random, const cv::Scalar& color) {
  cv::Mat image = speckled(random, {1024, 1024}, color, 7, 5);
  const int step = 128;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const cv::Point c(x * step + (y % 2) * step / 2 + step / 4, y * step + step / 2);
      const cv::Scalar ink = scaled(color, random.uniform(0.80, 0.90));
      diamond(image, c, 15 + random.integer(8), ink);
      for (int k = 0; k < 4; ++k) {
        const double a = random.uniform(0, 6.28);
        const cv::Point d(static_cast<int>(30 * std::cos(a)), static_cast<int>(30 * std::sin(a)));
        cv::circle(image, c + d, 3 + random.integer(4), ink, -1, cv::LINE_AA);
      }
    }
  return image;
}

cv::Mat fabric(Random& random, const cv::Scalar& color, double contrast) {
  cv::Mat image = speckled(random, {256, 256}, color, 9 * contrast, 10 * contrast);
  weave(image, 4, 4 * contrast);
  return image;
}

cv::Mat patterned_fabric(Random& random, const cv::Scalar& color) {
  cv::Mat image = speckled(random, {256, 256}, color, 6, 4);
  const cv::Scalar ink = vivid(random, 40, 230);
  const int kind = random.integer(3);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) {
      const cv::Point c(26 + x * 51, 26 + y * 51);
      if (kind == 0) cv::circle(image, c, 12, ink, (x + y) % 2 == 0 ? -1 : 4, cv::LINE_AA);
      if (kind == 1) diamond(image, c, 22, (x + y) % 2 == 0 ? ink : scaled(ink, 0.6));
      if (kind == 2)
        cv::rectangle(image, c - cv::Point(13, 13), c + cv::Point(13, 13),
                      (x + y) % 2 == 0 ? ink : scaled(color, 0.7), -1);
    }
  weave(image, 2, 4);
  return image;
}

cv::Mat leaves(Random& random) {
  cv::Mat image = speckled(random, {256, 256}, cv::Scalar(40, 105, 50), 22, 10);
  cv::line(image, {0, 128}, {255, 128}, cv::Scalar(90, 175, 125), 6, cv::LINE_AA);
  for (int x = 10; x < 256; x += 24)
    for (const int side : {-110, 110})
      cv::line(image, {x, 128}, {x + 60, 128 + side}, cv::Scalar(70, 145, 90), 2, cv::LINE_AA);
  return image;
}

}  // namespace rds::simulator::paint
