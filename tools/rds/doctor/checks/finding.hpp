// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rds::doctor {

/// kHint: works, but could be better. kFault: a run will fail or be spoiled.
enum class Verdict { kGood, kHint, kFault };

/// What a check found, in one sentence.
struct Finding {
  Verdict verdict = Verdict::kGood;
  std::string subject;
  std::string sentence;
};

/// Aligned lines `ok|hint|FAULT subject sentence`.
std::string to_text(const std::vector<Finding>& findings);
bool any_fault(const std::vector<Finding>& findings);

}  // namespace rds::doctor
