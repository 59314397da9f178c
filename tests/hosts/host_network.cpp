// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/host_network.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rds::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLimit = 10s;
const std::string kSwitch;  // its name among the hosts'
const std::string kNsenter = "/usr/bin/nsenter";
/// What waits at the slow side of a link, as in a card's queue of a thousand packets.
constexpr const char* kQueue = "burst 64kb limit 1500kb";
/// For the kernel's filter: an IPv4 frame that begins a TCP connection (SYN without ACK) is dropped.
constexpr const char* kNoDialling =
    "9,40 0 0 12,21 0 6 2048,48 0 0 23,21 0 4 6,48 0 0 47,84 0 0 18,21 0 1 2,6 0 0 2,6 0 0 0";

/// A process that holds a network namespace of its own.
std::unique_ptr<Process> hold_namespace() {
  auto holder = std::make_unique<Process>(
      std::vector<std::string>{"unshare", "--net", "sh", "-c", "echo holds; exec sleep infinity"});
  if (!holder->wait_for_output("holds", kLimit))
    throw std::runtime_error("no network namespace can be made: " + holder->standard_error());
  return holder;
}

std::string namespace_of(pid_t pid) {
  return fmt::format("/proc/{}/ns/net", pid);
}

/// The n-th of the kernel's figures of this host's link.
std::uint64_t link_figure(int n) {
  std::ifstream interfaces("/proc/thread-self/net/dev");
  for (std::string line; std::getline(interfaces, line);) {
    const auto colon = line.find("eth0:");
    if (colon == std::string::npos) continue;
    std::istringstream fields(line.substr(colon + 5));
    std::uint64_t field = 0;
    for (int i = 0; i < n; ++i) fields >> field;
    return field;
  }
  throw std::runtime_error("this host has no link");
}

}  // namespace

std::string HostNetwork::why_not() {
  if (geteuid() != 0) return "network namespaces need root";
  const auto shell = [](const char* command) { return run_process({"sh", "-c", command}, kLimit).status; };
  if (shell("for p in unshare nsenter ip bridge tc sysctl; do command -v $p || exit 1; done") != 0)
    return "unshare, nsenter, ip, bridge, tc or sysctl is missing";
  const std::string trial = fmt::format(
      "unshare --net sh -ec 'ip link add name one type veth peer name other; ip link add name b type bridge "
      "mcast_snooping 0; ip link set one master b; bridge link set dev one mcast_flood off; "
      "tc qdisc add dev other root tbf rate 40mbit {}'",
      kQueue);
  if (shell(trial.c_str()) != 0) return "no network namespaces with veth, a bridge and tbf can be made here";
  return "";
}

HostNetwork::HostNetwork(const std::vector<std::string>& hosts, const Link& link, bool multicast)
    : multicast_(multicast) {
  holders_[kSwitch] = hold_namespace();
  run(kSwitch,
      "sysctl -qw net.ipv6.conf.default.disable_ipv6=1; ip link add name bridge0 type bridge mcast_snooping "
      "0; "
      "ip link set bridge0 up");
  for (const std::string& host : hosts) add_host(host);
  limit_rate(hosts.front(), link.rate_mbit);
  if (link.is_impaired()) add_wire(hosts.front(), link.impairment);
  for (const std::string& host : hosts) plug(host);
}

void HostNetwork::add_host(const std::string& host) {
  const pid_t holder = (holders_[host] = hold_namespace())->pid();
  ports_[host] = "to" + host;
  addresses_[host] = fmt::format("10.77.0.{}", addresses_.size() + 1);
  run(host, "sysctl -qw net.ipv6.conf.default.disable_ipv6=1");
  run(kSwitch, fmt::format("ip link add name to{} type veth peer name eth0 netns {}; ip link set to{} up",
                           host, holder, host));
  run(host, fmt::format("ip link set lo up; ip address add {}/24 dev eth0; ip link set eth0 up; "
                        "ip route add 224.0.0.0/4 dev eth0",
                        addresses_[host]));
}

void HostNetwork::limit_rate(const std::string& host, int rate_mbit) const {
  run(host, fmt::format("tc qdisc add dev eth0 root tbf rate {}mbit {}", rate_mbit, kQueue));
  run(kSwitch, fmt::format("tc qdisc add dev to{} root tbf rate {}mbit {}", host, rate_mbit, kQueue));
}

/// The switch's port becomes the far end of the wire.
void HostNetwork::add_wire(const std::string& host, const Impairment& impairment) {
  run(kSwitch,
      "ip link add name wire type veth peer name behind; ip link set wire up; ip link set behind up");
  std::vector<std::string> command{RDS_WIRE, ports_[host], "wire"};
  for (const double number : {impairment.delay_ms, impairment.jitter_ms, impairment.loss})
    command.push_back(std::to_string(number));
  command.emplace_back("1");
  wire_ = std::make_unique<Process>(on(kSwitch, command));
  if (!wire_->wait_for_output("carries frames", kLimit)) throw std::runtime_error(wire_->standard_error());
  ports_[host] = "behind";
}

std::string HostNetwork::namespace_file(const std::string& host) const {
  return namespace_of(holders_.at(host)->pid());
}

std::vector<std::string> HostNetwork::on(const std::string& host,
                                         const std::vector<std::string>& command) const {
  std::vector<std::string> all{kNsenter, "--net=" + namespace_file(host), "--"};
  all.insert(all.end(), command.begin(), command.end());
  return all;
}

void HostNetwork::run(const std::string& host, const std::string& script) const {
  const ProcessResult result = run_process(on(host, {"sh", "-ec", script}), kLimit);
  if (result.status != 0) throw std::runtime_error(script + ": " + result.standard_error);
}

void HostNetwork::unplug(const std::string& host) {
  run(kSwitch, fmt::format("ip link set {} nomaster", ports_.at(host)));
}

void HostNetwork::plug(const std::string& host) {
  const std::string& port = ports_.at(host);
  run(kSwitch, fmt::format("ip link set {0} master bridge0; bridge link set dev {0} mcast_flood {1}", port,
                           multicast_ ? "on" : "off"));
}

void HostNetwork::hide(const std::string& host) {
  run(kSwitch,
      fmt::format("tc qdisc add dev to{0} clsact; tc filter add dev to{0} egress bpf da bytecode '{1}'", host,
                  kNoDialling));
}

std::string HostNetwork::address(const std::string& host) const {
  return addresses_.at(host);
}

OnHost::OnHost(const HostNetwork& network, const std::string& host)
    : before_(open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC)) {
  const int there = open(network.namespace_file(host).c_str(), O_RDONLY | O_CLOEXEC);
  const bool entered = before_ >= 0 && there >= 0 && setns(there, CLONE_NEWNET) == 0;
  if (there >= 0) close(there);
  if (entered) return;
  if (before_ >= 0) close(before_);
  throw std::runtime_error(host + ": its network namespace cannot be entered");
}

OnHost::~OnHost() {
  (void)setns(before_, CLONE_NEWNET);
  close(before_);
}

void in_own_process(const std::function<void()>& work) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork: no process for a trial");
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    int status = 0;
    try {
      work();
    } catch (const std::exception& e) {
      fmt::print("{}\n", e.what());
      status = 1;
    }
    std::fflush(nullptr);
    _exit(status);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw std::runtime_error("the trial in its own process failed, see above");
}

std::uint64_t bytes_sent() {
  constexpr int kSentBytes = 9;  // eight of what was received come before
  return link_figure(kSentBytes);
}

std::uint64_t bytes_received() {
  return link_figure(1);
}

}  // namespace rds::test
