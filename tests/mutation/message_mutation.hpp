// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "common/messages/fields.hpp"

namespace rds::test {

/// Spoils fields of messages, so that they are still messages of their type: every string, number, flag and
/// length can become one that is easily wrong. The same seed spoils in the same ways.
class MessageMutation {
 public:
  explicit MessageMutation(std::uint64_t seed) : random_(seed) {}

  /// Changes one to three fields; of a list of parts the list or one of its parts.
  template <class Message>
  void spoil(Message& message) {
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
      part_ = random_();
      std::size_t leaves = 0;
      walk(message, [&leaves](auto&) { ++leaves; });
      std::size_t chosen = below(leaves);
      walk(message, [&](auto& leaf) {
        if (chosen-- == 0) change(leaf);
      });
    }
  }

  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

 private:
  static constexpr std::size_t kMostElements = 100'000;

  template <class T>
  static constexpr bool is_simple = std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;

  template <class T, class Visit>
  void walk(T& value, const Visit& visit) {
    if constexpr (is_simple<T>)
      visit(value);
    else
      messages::Fields<T>::visit(value, [&](const char*, auto& member) { walk(member, visit); });
  }
  template <class T, class Visit>
  void walk(std::vector<T>& list, const Visit& visit) {
    visit(list);
    if constexpr (!is_simple<T>)
      if (!list.empty()) walk(list[part_ % list.size()], visit);
  }
  template <class T, std::size_t N, class Visit>
  void walk(std::array<T, N>& list, const Visit& visit) {
    walk(list[part_ % N], visit);
  }
  template <class Visit>
  void walk(std::vector<bool>& list, const Visit& visit) {
    visit(list);
  }

  void change(bool& value) { value = !value; }
  void change(std::string& value) {
    const std::array<std::string, 7> wrong{
        "",          "\xff\xfe",     std::string(65'000, 'x'), std::string("a\0b", 3),
        "../../etc", value + "\xc3", "%s{}\n\033[2J"};
    value = wrong.at(below(wrong.size()));
  }
  template <class T>
  requires std::is_floating_point_v<T>
  void change(T& value) {
    using Limits = std::numeric_limits<T>;
    const std::array<T, 9> wrong{Limits::quiet_NaN(),
                                 Limits::infinity(),
                                 -Limits::infinity(),
                                 Limits::max(),
                                 Limits::denorm_min(),
                                 T{0},
                                 -value,
                                 value * T{1e6},
                                 T{-1e6}};
    value = wrong.at(below(wrong.size()));
  }
  template <class T>
  requires std::is_integral_v<T>
  void change(T& value) {
    using Limits = std::numeric_limits<T>;
    const std::array<T, 7> wrong{T{0},
                                 T{1},
                                 Limits::max(),
                                 Limits::min(),
                                 static_cast<T>(value + 1),
                                 static_cast<T>(value - 1),
                                 static_cast<T>(random_())};
    value = wrong.at(below(wrong.size()));
  }
  template <class T>
  void change(std::vector<T>& list) {
    const std::size_t size = list.size();
    switch (below(6)) {
      case 0:
        return list.clear();
      case 1:
        return list.resize(size > 0 ? size - 1 : 1);
      case 2:
        return list.resize(size + 1);
      case 3:
        return list.resize(std::min(kMostElements, 2 * size + 1));
      case 4:
        if constexpr (is_simple<T>) return list.resize(kMostElements);
        return;
      default:
        if constexpr (is_simple<T> && !std::is_same_v<T, bool>)
          if (size > 0) change(list[below(size)]);
    }
  }

  std::mt19937_64 random_;
  std::uint64_t part_ = 0;  // which part of a list is looked at
};

}  // namespace rds::test
