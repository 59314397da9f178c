// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::doctor {

/// What of a frame tells whether its depth picture lies on its colour picture.
struct EdgeView {
  cv::Mat gradient;                      // CV_32FC1, 0 … 1: how strong the colour picture's edges are
  double shrink = 1;                     // gradient's pixels per pixel of the frame
  std::vector<cv::Point2f> depth_edges;  // near side of depth's jumps [px of the frame]
};

/// Finds the edges of a frame: the gradient at a width of 320 px, clipped at its 90th percentile, and up to
/// 300 pixels beside which depth is at least 8 % farther.
///
/// @param gray   CV_8UC1.
/// @param depth  CV_16UC1 or CV_32FC1 of the same size in any unit, 0 = no measurement.
EdgeView find_edges(const cv::Mat& gray, const cv::Mat& depth);

/// Where depth's pixel p lies in the colour picture: centre + scale · (p − centre) + shift.
struct DepthPlacement {
  double scale = 1;
  cv::Point2d shift_px{0, 0};
};

/// How well depth's edges fall on colour's, as it is and where they fit best. An agreement is the mean
/// gradient under depth's edges, 0 … 1; all are measured on frames that the fit has not seen.
struct RegistrationFit {
  DepthPlacement best;
  double agreement = 0;         // of `best`
  double agreement_as_is = 0;   // of no scale and no shift
  double agreement_beside = 0;  // of `best` moved aside by 5 % of the width: what chance gives
  double frames_better = 0;     // share of the frames where `best` agrees better than as is
  double farthest_px = 0;       // how far `best` moves the pixels of the picture's corners at most
};

/// Searches scales 0.6 … 1.7 and shifts up to 5 % of the width for the placement in which the edges agree
/// best: a grid first, then ever finer steps around its maximum. Every second view is fitted, the others
/// judge.
///
/// @param views   of frames all over the recording.
/// @param center  of the scale [px], the principal point.
/// @param size    of the frames [px].
/// @return nullopt with fewer than ten views of at least fifty depth edges: nothing can be told.
std::optional<RegistrationFit> fit_registration(std::span<const EdgeView> views, cv::Point2d center,
                                                cv::Size size);

/// True if depth lies elsewhere than where it should: the fit moves pixels by more than 1 % of the diagonal
/// and the edges agree clearly better there, both than as is and than by chance.
bool is_misplaced(const RegistrationFit& fit, cv::Size2d size);

}  // namespace rds::doctor
