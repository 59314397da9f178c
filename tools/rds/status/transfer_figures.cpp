// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/status/transfer_figures.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

namespace rds::tools {
namespace {

using Values = std::vector<diagnostic_msgs::msg::KeyValue>;

/// nullopt if it is not there, or no such number.
std::optional<std::uint64_t> number_of(const Values& values, std::string_view key, int base = 10) {
  const auto found = std::ranges::find_if(values, [key](const auto& value) { return value.key() == key; });
  if (found == values.end()) return std::nullopt;
  const std::string& text = found->value();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::optional<TransferFigures> figures_in(const Values& values) {
  const auto lacking = number_of(values, "transfer items lacking");
  if (!lacking) return std::nullopt;
  const auto thousands = [&](std::string_view key) {
    return static_cast<double>(number_of(values, key).value_or(0)) / 1e3;
  };
  return TransferFigures{*lacking, thousands("transfer round trip us"), thousands("transfer link kbit_s")};
}

}  // namespace

void TransfersHeard::take(const diagnostic_msgs::msg::DiagnosticArray& report) {
  const std::lock_guard lock(mutex_);
  for (const auto& status : report.status()) {
    const auto instance = number_of(status.values(), "instance", 16);
    if (instance && (figures_.contains(*instance) || figures_.size() < kMost))
      figures_[*instance] = figures_in(status.values());
  }
}

TransfersHeard::Figures TransfersHeard::figures() const {
  const std::lock_guard lock(mutex_);
  return figures_;
}

}  // namespace rds::tools
