// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

/// The subcommands of `rds`; each adds itself with its options.
///
/// Their callbacks print to stdout. Bad usage and files that cannot be read or written: one sentence to
/// stderr and CLI::RuntimeError(2). What was asked for is not so (a fault, a difference, nobody on the bus in
/// time): CLI::RuntimeError(1). Ctrl-C ends them early, as if all had been seen.
namespace rds {

namespace run {
/// `rds run`: the whole chain on one recording.
void add_run_command(CLI::App& rds);
}  // namespace run

namespace play {
/// `rds play`: publishes a recording as a camera would.
void add_play_command(CLI::App& rds);
}  // namespace play

namespace record {
/// `rds record FILE [TOPIC...]`: records topics; `rds record --recover FILE`: makes a torn file whole.
void add_record_command(CLI::App& rds);
}  // namespace record

namespace doctor {
/// `rds doctor`: is this machine ready? `rds doctor --dataset DIR`: is this recording fit to be run?
void add_doctor_command(CLI::App& rds);
}  // namespace doctor

namespace secure {
/// `rds secure init FOLDER`: the certificates of a secured domain.
void add_secure_command(CLI::App& rds);
}  // namespace secure

namespace tools {
/// `rds convert FROM TO`: writes a recording in another form.
void add_convert_command(CLI::App& rds);
/// `rds eval GROUNDTRUTH TRAJECTORY`: ATE and RPE of a trajectory, with a plot.
/// `rds eval DATASET OUT [--background DIR]`: the figures of a whole run.
void add_eval_command(CLI::App& rds);
/// `rds hosts compose`: services on several machines.
void add_hosts_command(CLI::App& rds);
/// `rds map info|save|export|query|diff|list|load`: a map from a file (--map map.ot) or, without it, the live
/// one.
void add_map_command(CLI::App& rds);
/// `rds topic list|echo|hz|bw`: looks at the live bus, whichever process publishes; `table`: what there can be.
void add_topic_command(CLI::App& rds);
/// `rds status`: which services are on the bus and whether they are well.
void add_status_command(CLI::App& rds);
/// `rds models list|fetch|check`: the detector's networks. Faults are std::runtime_error (one sentence).
void add_models_command(CLI::App& rds);
/// `rds router`: passes messages on between machines with --bus zenoh.
void add_router_command(CLI::App& rds);
/// `rds simulate --out DIR`: renders a recording of a furnished room with walking people, with its truth.
void add_simulate_command(CLI::App& rds);
}  // namespace tools

}  // namespace rds
