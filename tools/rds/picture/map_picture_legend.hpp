// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace rds::tools {

inline const cv::Scalar kInk(52, 44, 40);

/// @param at  left end of the base line [px].
void put_text(cv::Mat& image, const std::string& text, cv::Point at, double scale, const cv::Scalar& color,
              int thickness = 1);

/// One line of signs and words below a picture, from left to right.
class PictureLegend {
 public:
  /// @param footer_px  height of the strip at the bottom in which it stands.
  PictureLegend(cv::Mat& picture, int margin_px, int footer_px);

  void line(const std::string& text, const cv::Scalar& color);
  void dot(const std::string& text, const cv::Scalar& color);
  void square(const std::string& text, const cv::Scalar& color);
  /// True while there is room for an entry and the last one.
  [[nodiscard]] bool has_room(const std::string& text, const std::string& last) const;

 private:
  void put(const std::string& text, int sign_width);

  cv::Mat& picture_;
  int x_;
  int y_;
};

}  // namespace rds::tools
