// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/models_command.hpp"

#include <chrono>
#include <iostream>
#include <memory>

#include <fmt/ostream.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/network_script.hpp"

namespace rds::tools {
namespace {

using detector::DetectorError;
using detector::ModelFolders;
using detector::NetworkDescription;

/// The names of the networks for which `wanted` holds.
template <class Predicate>
std::vector<std::string> names_where(Predicate wanted) {
  std::vector<std::string> names;
  for (const NetworkDescription& network : detector::shipped_networks())
    if (wanted(network)) names.push_back(network.name);
  return names;
}

/// Computes one picture by a back end and says how long that took, after the detector's own first
/// computation.
std::string time_of_one_picture(const detector::Network& network, const std::string& backend) {
  detector::DetectorConfig config;
  config.backend = backend;
  detector::Detector detector(network, config);
  const image::ColorImage grey{cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(128)), image::ChannelOrder::kBgr,
                               nullptr};
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(detector.detect(grey));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return fmt::format("{:.1f} ms ({})", took.count(), detector.library());
}

/// The same for each back end, the one that is used by default first.
std::string times_of_one_picture(const std::string& name, const ModelFolders& folders) {
  const detector::Network network = detector::load_network(name, folders);
  std::vector<std::string> times;
  for (const std::string& backend : detector::backends())
    times.push_back(time_of_one_picture(network, backend));
  return fmt::format("{}", fmt::join(times, ", "));
}

/// Options that outlive the callbacks they belong to.
struct Options {
  std::string model_dir;
  std::vector<std::string> names;
};

}  // namespace

void list_models(std::ostream& out, const ModelFolders& folders) {
  const std::string preferred = detector::default_network(folders);
  for (const NetworkDescription& network : detector::shipped_networks()) {
    const auto file = detector::find_file(network, folders);
    const std::string place = file                    ? file->string()
                              : network.fetch.empty() ? "missing"
                                                      : fmt::format("missing (`{}`)", network.fetch);
    fmt::print(out, "{} {:<24} {:<40} {}\n", network.name == preferred ? '*' : ' ', network.name,
               network.licence, place);
  }
  fmt::print(out, "* is used where no other network is named.\n");
}

void fetch_models(std::ostream& out, const std::vector<std::string>& names) {
  const auto can_be_fetched = [](const NetworkDescription& network) { return !network.fetch.empty(); };
  for (const std::string& name : names.empty() ? names_where(can_be_fetched) : names) {
    const NetworkDescription network = detector::find_description(name, {});
    if (!can_be_fetched(network))
      throw DetectorError(fmt::format("{}: cannot be fetched; its source is: {}", name, network.source));
    const auto cache = detector::model_cache();
    if (cache.empty()) throw DetectorError("the user's cache: expected XDG_CACHE_HOME or HOME to be set");
    run_network_script("fetch_" + name + ".sh", cache);
    static_cast<void>(detector::load_network(network, {cache}));
    fmt::print(out, "{}: {}\n", name, (cache / network.file).string());
  }
}

void check_models(std::ostream& out, const std::vector<std::string>& names, const ModelFolders& folders) {
  const auto is_found = [&](const NetworkDescription& n) {
    return detector::find_file(n, folders).has_value();
  };
  const std::vector<std::string> wanted = names.empty() ? names_where(is_found) : names;
  if (wanted.empty()) throw DetectorError("no network's file is found; `rds models fetch` brings one");
  std::string first_fault;
  for (const std::string& name : wanted) {
    try {
      const std::string times = times_of_one_picture(name, folders);
      fmt::print(out, "{}: ok, a picture on one thread takes {}\n", name, times);
    } catch (const std::runtime_error& e) {
      fmt::print(out, "{}: not usable\n", name);
      if (first_fault.empty()) first_fault = e.what();
    }
  }
  if (!first_fault.empty()) throw DetectorError(first_fault);
}

void add_models_command(CLI::App& rds) {
  const auto options = std::make_shared<Options>();
  CLI::App* models = rds.add_subcommand("models", "The detector's trained networks");
  models->require_subcommand(1);
  models->add_option("--model-dir", options->model_dir, "Folder that is searched first");

  models->add_subcommand("list", "Networks, whether their file is found, licence")->callback([options] {
    list_models(std::cout, detector::model_folders(options->model_dir));
  });
  CLI::App* fetch = models->add_subcommand("fetch", "Put networks into the user's cache");
  fetch->add_option("network", options->names, "Default: all that can be fetched");
  fetch->callback([options] { fetch_models(std::cout, options->names); });
  CLI::App* check = models->add_subcommand("check", "Verify files and compute each network once");
  check->add_option("network", options->names, "Default: all whose file is found");
  check->callback(
      [options] { check_models(std::cout, options->names, detector::model_folders(options->model_dir)); });
}

}  // namespace rds::tools
