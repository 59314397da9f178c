// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "tools/simulator/rendering/random.hpp"

/// Procedural pictures (CV_8UC3, BGR). Every one is a function of its random stream.
namespace rds::simulator::paint {

/// Smooth noise of several octaves, CV_32FC1 about −1 … 1; `cells` counts the lattice cells of the first
/// octave.
cv::Mat noise(Random& random, cv::Size size, cv::Size cells, int octaves);

/// One colour with blotches and grain of the given strength [grey levels].
cv::Mat speckled(Random& random, cv::Size size, const cv::Scalar& color, double blotches, double grain);

/// Wood whose grain runs along u.
cv::Mat wood(Random& random, const cv::Scalar& color, double contrast = 1);
/// Parquet of staggered planks, each from another tree.
cv::Mat parquet(Random& random, const cv::Scalar& color);
/// Woven carpet with borders and ornaments.
cv::Mat carpet(Random& random);
/// Wall with a small printed pattern.
cv::Mat wallpaper(Random& random, const cv::Scalar& color);
/// Painted wall with small dents and stains.
cv::Mat plaster(Random& random, const cv::Scalar& color);
/// Stone floor with chips of other shades.
cv::Mat terrazzo(Random& random, const cv::Scalar& color);
/// Woven cloth of one colour.
cv::Mat fabric(Random& random, const cv::Scalar& color, double contrast = 1);
/// Cushion or curtain with a two-colour pattern.
cv::Mat patterned_fabric(Random& random, const cv::Scalar& color);
cv::Mat leaves(Random& random);

/// A framed picture: landscape, geometry or still life.
cv::Mat picture(Random& random);
/// A printed poster with headline, shapes and paragraphs.
cv::Mat poster(Random& random);
/// Whiteboard with formulas and sketches.
cv::Mat whiteboard(Random& random);
/// Sixteen book spines side by side.
cv::Mat book_spines(Random& random);
cv::Mat cardboard(Random& random);
/// What a monitor shows: an editor or a browser.
cv::Mat screen(Random& random);
cv::Mat keyboard(Random& random);
cv::Mat bottle_label(Random& random, const cv::Scalar& glass);
cv::Mat window_view(Random& random);
cv::Mat clock_face();
/// A cover as magazines and boxes have it.
cv::Mat cover(Random& random);

/// A colour well off grey, in BGR; every hue is as likely.
cv::Scalar vivid(Random& random, double low = 40, double high = 210);
/// Rows of letters as far as `area` reaches.
void text_block(cv::Mat& image, cv::Rect area, int line_px, const cv::Scalar& color, Random& random);
std::string word(Random& random, int letters);

}  // namespace rds::simulator::paint
