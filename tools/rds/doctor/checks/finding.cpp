// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/finding.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace rds::doctor {
namespace {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "ok";
    case Verdict::kHint:
      return "hint";
    case Verdict::kFault:
      return "FAULT";
  }
  return "";
}

}  // namespace

std::string to_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const auto& finding : findings)
    text += fmt::format("{:<6} {:<18} {}\n", name_of(finding.verdict), finding.subject, finding.sentence);
  return text;
}

bool any_fault(const std::vector<Finding>& findings) {
  return std::ranges::any_of(findings, [](const auto& f) { return f.verdict == Verdict::kFault; });
}

}  // namespace rds::doctor
