// SPDX-License-Identifier: Apache-2.0
// How many of the visible people of a recording with people.json a network finds, and how good their depth
// is.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/image/tum_dataset.hpp"
#include "services/detector/models/model_store.hpp"

namespace {

using rds::detector::Detection;

constexpr double kVisibleFraction = 0.5;  // as tools/score.py of the recordings
constexpr double kVisibleAreaPx = 2500;
constexpr double kFoundIou = 0.5;
constexpr double kTouchesIou = 0.1;

struct Person {
  rds::geometry::Box2 box;
  double distance_m = 0;
  bool visible = false;
};

struct Figures {
  std::size_t frames = 0;
  std::size_t visible = 0;
  std::size_t found = 0;
  std::size_t false_persons = 0;
  std::size_t without_depth = 0;
  std::vector<double> depth_errors_m;
};

std::map<std::string, std::vector<Person>> read_people(const std::string& dataset) {
  std::ifstream file(dataset + "/people.json");
  if (!file) throw std::runtime_error(dataset + "/people.json: cannot be read");
  std::map<std::string, std::vector<Person>> people_at;
  const auto truth = nlohmann::json::parse(file);
  for (const auto& frame : truth.at("frames")) {
    auto& people = people_at[frame.at("timestamp").get<std::string>()];
    for (const auto& p : frame.at("people")) {
      const auto b = p.at("box").get<std::vector<double>>();
      const bool visible = p.at("visible_fraction").get<double>() > kVisibleFraction &&
                           p.at("area").get<double>() > kVisibleAreaPx;
      people.push_back({{b.at(0), b.at(1), b.at(2), b.at(3)}, p.at("distance").get<double>(), visible});
    }
  }
  return people_at;
}

void score_frame(const std::vector<Person>& people, const std::vector<Detection>& found, Figures& figures) {
  ++figures.frames;
  for (const Person& person : people) {
    if (!person.visible) continue;
    ++figures.visible;
    const auto overlap = [&](const Detection& d) { return d.label == "person" ? iou(d.box, person.box) : 0; };
    const auto best = std::ranges::max_element(found, {}, overlap);
    if (best == found.end() || overlap(*best) <= kFoundIou) continue;
    ++figures.found;
    if (best->depth_m <= 0)
      ++figures.without_depth;
    else
      figures.depth_errors_m.push_back(static_cast<double>(best->depth_m) - person.distance_m);
  }
  for (const Detection& d : found) {
    const auto touches = [&](const Person& p) { return iou(d.box, p.box) > kTouchesIou; };
    if (d.label == "person" && std::ranges::none_of(people, touches)) ++figures.false_persons;
  }
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void print(const std::string& network, const std::string& dataset, const Figures& f) {
  const double bias_m =
      quantile(f.depth_errors_m, 0.5);  // `distance` is the person's middle, depth that of the surface
  std::vector<double> errors_m;
  std::vector<double> spread_m;
  for (const double error : f.depth_errors_m) {
    errors_m.push_back(std::abs(error));
    spread_m.push_back(std::abs(error - bias_m));
  }
  fmt::print("{} {}: {} frames, recall {:.3f} ({} of {} visible people), false persons per frame {:.3f}, ",
             network, dataset, f.frames,
             static_cast<double>(f.found) / std::max(1.0, static_cast<double>(f.visible)), f.found, f.visible,
             static_cast<double>(f.false_persons) / std::max(1.0, static_cast<double>(f.frames)));
  fmt::print(
      "depth error median {:.3f} m, median difference {:+.3f} m, from which 50 % / 90 % / all lie within "
      "{:.3f} / "
      "{:.3f} / {:.3f} m, without depth {}\n",
      quantile(errors_m, 0.5), bias_m, quantile(spread_m, 0.5), quantile(spread_m, 0.9),
      quantile(spread_m, 1), f.without_depth);
}

struct Options {
  std::string network;
  std::string dataset;
  std::string model_dir;
  std::size_t every = 5;
  rds::detector::DetectorConfig detector;
};

void run(const Options& options) {
  const auto people_at = read_people(options.dataset);
  const auto dataset = rds::image::TumDataset::open(options.dataset);
  if (!dataset) throw std::runtime_error(dataset.error());
  const auto folders = rds::detector::model_folders(options.model_dir);
  rds::detector::Detector detector(rds::detector::load_network(options.network, folders), options.detector);
  Figures figures;
  for (std::size_t i = 0; i < dataset->frames().size(); i += options.every) {
    const auto people = people_at.find(dataset->frames()[i].stamp_text);
    if (people == people_at.end()) continue;
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    score_frame(people->second, detector.detect(frame->color, frame->depth), figures);
  }
  print(detector.network().name, options.dataset, figures);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Recall of a network on a recording with people.json");
  app.add_option("network", options.network, "name of a network, or a YAML file that describes one")
      ->required();
  app.add_option("dataset", options.dataset, "TUM folder with people.json")->required();
  app.add_option("--every", options.every, "only every n-th frame")->check(CLI::PositiveNumber);
  app.add_option("--model-dir", options.model_dir, "folder that is searched for networks first");
  app.add_option("--precision", options.detector.precision, "f32 or bf16")
      ->check(CLI::IsMember({"f32", "bf16"}));
  app.add_option("--backend", options.detector.backend, "inference library: openvino or opencv");
  app.add_option("--score", options.detector.score_threshold, "lowest score; 0: the network's own")
      ->check(CLI::Range(0., 1.));
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  return 0;
}
