// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/hosts/hosts_table.hpp"

namespace rds::test {

/// Runs a row on one machine and keeps what others are compared with.
void expect_baseline(const Row& row);

/// Runs a row, prints its line of the table and expects what its bounds say, compared with one machine.
void expect_row(const Row& row);

/// The tracker is as fast as alone where the other services run on other machines.
void expect_split_cores(const CoreRows& rows);

}  // namespace rds::test
