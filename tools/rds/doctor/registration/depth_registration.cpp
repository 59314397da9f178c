// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/registration/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rds::doctor {
namespace {
constexpr double kScaleStep = 1.02;
constexpr int kScales = 27;            // 0.59 … 1.71
constexpr double kWidestShift = 0.05;  // of the width; half of it vertically
constexpr int kShifts = 8;
constexpr int kRefinements = 4;           // halvings of the steps
constexpr double kFewestInside = 0.25;    // of the edges; fewer tell nothing about the placement
constexpr std::size_t kFewestEdges = 50;  // of a view
constexpr std::size_t kFewestViews = 10;
constexpr double kFarthestGood = 0.01;  // of the diagonal
constexpr double kClearlyBetter = 1.15;
constexpr double kMostFrames = 0.8;

struct GradientSum {
  double sum = 0;
  std::size_t inside = 0;
};

float at_subpixel(const cv::Mat& picture, double x, double y) {
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const float fx = static_cast<float>(x - x0);
  const float fy = static_cast<float>(y - y0);
  const auto* upper = picture.ptr<float>(y0) + x0;
  const auto* lower = picture.ptr<float>(y0 + 1) + x0;
  return (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) + fy * ((1 - fx) * lower[0] + fx * lower[1]);
}

GradientSum gradient_under_edges(const EdgeView& view, cv::Point2d center, const DepthPlacement& placement) {
  GradientSum result;
  const cv::Point2d offset = center - placement.scale * center + placement.shift_px;
  for (const auto& edge : view.depth_edges) {
    const double x = (placement.scale * edge.x + offset.x + 0.5) * view.shrink - 0.5;
    const double y = (placement.scale * edge.y + offset.y + 0.5) * view.shrink - 0.5;
    if (x < 0 || y < 0 || x >= view.gradient.cols - 1 || y >= view.gradient.rows - 1) continue;
    result.sum += at_subpixel(view.gradient, x, y);
    ++result.inside;
  }
  return result;
}

using Views = std::vector<const EdgeView*>;

double agreement_of(const Views& views, cv::Point2d center, const DepthPlacement& placement) {
  GradientSum total;
  std::size_t edges = 0;
  for (const auto* view : views) {
    const auto of_view = gradient_under_edges(*view, center, placement);
    total.sum += of_view.sum;
    total.inside += of_view.inside;
    edges += view->depth_edges.size();
  }
  const bool enough = static_cast<double>(total.inside) > kFewestInside * static_cast<double>(edges);
  return enough ? total.sum / static_cast<double>(total.inside) : 0;
}

/// A grid of placements: so many steps to each side, of such a size.
struct Grid {
  int scales;
  double factor;
  cv::Size shifts;
  double step_px;
};

DepthPlacement best_around(const DepthPlacement& middle, const Grid& grid, const Views& views,
                           cv::Point2d center) {
  DepthPlacement best = middle;
  double most = agreement_of(views, center, middle);
  for (int i = -grid.scales; i <= grid.scales; ++i)
    for (int x = -grid.shifts.width; x <= grid.shifts.width; ++x)
      for (int y = -grid.shifts.height; y <= grid.shifts.height; ++y) {
        const DepthPlacement candidate{middle.scale * std::pow(grid.factor, i),
                                       middle.shift_px + grid.step_px * cv::Point2d(x, y)};
        const double agreement = agreement_of(views, center, candidate);
        if (agreement <= most) continue;
        most = agreement;
        best = candidate;
      }
  return best;
}

DepthPlacement search(const Views& views, cv::Point2d center, double width) {
  Grid grid{kScales, kScaleStep, {kShifts, kShifts / 2}, kWidestShift * width / kShifts};
  DepthPlacement best = best_around({}, grid, views, center);
  for (int i = 0; i < kRefinements; ++i) {
    grid = {1, std::sqrt(grid.factor), {1, 1}, grid.step_px / 2};
    best = best_around(best, grid, views, center);
  }
  return best;
}

/// The mean agreement at four places beside, out of reach of the best one's peak.
double agreement_beside(const Views& views, cv::Point2d center, const DepthPlacement& best, double width) {
  double sum = 0;
  for (const double x : {-kWidestShift, kWidestShift})
    for (const double y : {-kWidestShift, kWidestShift})
      sum += agreement_of(views, center, {best.scale, best.shift_px + width * cv::Point2d(x, y)});
  return sum / 4;
}

double share_of_better_views(const Views& views, cv::Point2d center, const DepthPlacement& best) {
  const auto better = std::ranges::count_if(views, [&](const EdgeView* view) {
    return agreement_of({view}, center, best) > agreement_of({view}, center, {});
  });
  return static_cast<double>(better) / static_cast<double>(views.size());
}

double farthest_of(const DepthPlacement& placement, cv::Point2d center, cv::Size2d size) {
  double farthest = 0;
  for (const double x : {0.0, size.width - 1})
    for (const double y : {0.0, size.height - 1})
      farthest = std::max(
          farthest, cv::norm((placement.scale - 1) * (cv::Point2d(x, y) - center) + placement.shift_px));
  return farthest;
}

}  // namespace

std::optional<RegistrationFit> fit_registration(std::span<const EdgeView> views, cv::Point2d center,
                                                cv::Size size) {
  Views fitted;
  Views judging;
  for (const auto& view : views)
    if (view.depth_edges.size() >= kFewestEdges)
      (fitted.size() > judging.size() ? judging : fitted).push_back(&view);
  if (fitted.size() + judging.size() < kFewestViews) return std::nullopt;
  RegistrationFit fit;
  fit.best = search(fitted, center, size.width);
  fit.agreement = agreement_of(judging, center, fit.best);
  fit.agreement_as_is = agreement_of(judging, center, {});
  fit.agreement_beside = agreement_beside(judging, center, fit.best, size.width);
  fit.frames_better = share_of_better_views(judging, center, fit.best);
  fit.farthest_px = farthest_of(fit.best, center, size);
  return fit;
}

bool is_misplaced(const RegistrationFit& fit, cv::Size2d size) {
  return fit.farthest_px > kFarthestGood * cv::norm(cv::Point2d(size.width, size.height)) &&
         fit.agreement > kClearlyBetter * std::max(fit.agreement_as_is, fit.agreement_beside) &&
         fit.frames_better >= kMostFrames;
}

}  // namespace rds::doctor
