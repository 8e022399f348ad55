#include "ros2_service.h"

#include <cstdlib>

#include <CLI/CLI.hpp>

#include "app/live/live_service.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr int domain_max = 232;  // higher numbers would give invalid ports

std::uint32_t domain_of(const Ros2Options& place) {
  if (place.domain != "-1") return static_cast<std::uint32_t>(std::stoul(place.domain));
  const char* const text = std::getenv("ROS_DOMAIN_ID");  // NOLINT(concurrency-mt-unsafe): before any thread
  if (text == nullptr || *text == '\0') return 0;
  const std::optional<int> domain = number_of<int>(text);
  if (!domain || *domain < 0 || *domain > domain_max)
    throw InputError(
        InputProblem{.file = "ROS_DOMAIN_ID",
                     .message = "'" + std::string(text) + "' must be from 0 to " + std::to_string(domain_max)});
  return static_cast<std::uint32_t>(*domain);
}

}  // namespace

void add_ros2_service(CLI::App& command, Ros2Options& place) {
  CLI::Option* ros2 =
      command
          .add_flag("--ros2{-1}", place.domain,
                    "Publish ROS 2 topics on this machine; --ros2=DOMAIN (default: ROS_DOMAIN_ID, else 0)")
          ->check(whole_within(-1, domain_max));
  command.add_option("--ros2-rate", place.rate_hz, "Rate of the topics (default: 100)")
      ->type_name("HZ")
      ->check(number_within(1.0, 1000.0))
      ->needs(ros2);
  command.add_flag("--ros2-commands", place.commands, "Carry out the commands that anybody sends to /kadans/command")
      ->needs(ros2);
}

Ros2Service::Ros2Service(const Ros2Options& place, Instance& instance, const Assembly& assembly, LivePace* pace,
                         int avoid_cpu) {
  if (!place.wanted()) return;
  domain_ = domain_of(place);
  const RobotTexts texts = robot_texts(assembly);
  bridge_ = std::make_unique<Ros2Bridge>(
      Ros2Settings{.domain = domain_, .rate_hz = place.rate_hz, .commands = place.commands, .avoid_cpu = avoid_cpu},
      Ros2Bridge::Parts{.instance = instance, .port = instance.open_port(), .texts = texts, .pace = pace});
}

void Ros2Service::start() {
  if (!bridge_) return;
  bridge_->start();
  print_line("ros2 in domain " + std::to_string(domain_));
}

void Ros2Service::stop() noexcept {
  if (bridge_) bridge_->stop();
}

}  // namespace kadans
