// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/rds/record/topic_subscriptions.hpp"
#include "tools/rds/run/services/run_options.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::run {

/// What the services of a run say to others, kept in a bag beside the results. It has a participant of its
/// own, as it reads what `rds run` reads as well.
class RunRecord {
 public:
  /// @throws bus::BusError; std::runtime_error with one sentence if the file cannot be written.
  RunRecord(const RunOptions& options, int domain, const std::filesystem::path& file);

  /// Subscribes to what has been found of it so far.
  void look() { subscriptions_->look(); }
  /// Whether all publishers of it have one more reader than before. @param before, now  of the services.
  [[nodiscard]] bool is_heard(const Endpoints& before, const Endpoints& now) const;

  /// Ends it, when nothing more is said. @return what went wrong, in one sentence; empty if nothing.
  std::string finish();

 private:
  std::filesystem::path file_;
  record::TopicChoice choice_ = record::TopicChoice::outputs();
  record::BagThread bag_;
  std::unique_ptr<record::TopicSubscriptions> subscriptions_;  // last: its callbacks use the bag
};

}  // namespace rds::run
