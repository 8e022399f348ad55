// `kadans dynamixel`: finds servos on a serial port, shows what they are, and gives them ids and baud rates, one by one
// on the bench. None of it gives torque.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/input_error.h"
#include "option_checks.h"
#include "plant/dynamixel/servo_bus.h"
#include "signal/input_file.h"
#include "terminal.h"

namespace kadans {
namespace {

// The bench of servos: each of its commands is one of `kadans dynamixel`.
struct DynamixelOptions {
  std::string device;
  std::uint32_t baud = 0;  // 0: scan looks at all, the others take 1000000
  std::uint32_t id = 1, new_id = 1, new_baud = 1'000'000;
  bool json = false;
};

}  // namespace

namespace dynamixel {
namespace {

constexpr std::int64_t bench_patience_ns = 20'000'000;
constexpr int bench_tries = 3;

struct FoundServo {
  std::uint32_t baud;
  std::uint8_t id;
  ServoBus::Identity identity;
};

std::string model_text(std::uint16_t number) {
  const ServoModel* const model = find_model(number);
  return model != nullptr ? std::string(model->name) : "model " + std::to_string(number);
}

[[noreturn]] void no_answer(const DynamixelOptions& options, Answer answer, std::uint8_t error) {
  const std::string servo = "servo " + std::to_string(options.id) + " on " + options.device;
  if (answer == Answer::refused) refuse(servo + " refuses: " + std::string(status_error_words(error)));
  if (answer == Answer::garbage) refuse(servo + " answers garbage: two servos have this id, or the line is disturbed");
  refuse(servo + " does not answer: `kadans dynamixel scan " + options.device + "` finds servos");
}

class Bench {
 public:
  explicit Bench(const DynamixelOptions& options)
      : options_(options),
        baud_(options.baud == 0 ? 1'000'000 : options.baud),
        port_(options.device, baud_),
        bus_(port_, baud_, bench_patience_ns) {}

  template <typename Ask>
  void insist(Ask ask) {
    Answer answer = Answer::silence;
    for (int i = 0; i < bench_tries && answer != Answer::good; ++i) answer = ask(bus_);
    if (answer != Answer::good) no_answer(options_, answer, bus_.error());
  }
  std::uint32_t read(Register which) {
    std::uint32_t value = 0;
    insist([&](ServoBus& bus) { return bus.read(id(), which, value); });
    return value;
  }
  void write(Register which, std::uint32_t value) {
    insist([&](ServoBus& bus) { return bus.write(id(), which, value); });
  }
  std::uint8_t id() const { return static_cast<std::uint8_t>(options_.id); }
  ServoBus& bus() { return bus_; }
  TerminalPort& port() { return port_; }

 private:
  const DynamixelOptions& options_;
  std::uint32_t baud_;
  TerminalPort port_;
  ServoBus bus_;
};

int scan(const DynamixelOptions& options) {
  std::vector<FoundServo> found;
  std::vector<std::uint32_t> bauds(baud_rates.begin(), baud_rates.end());
  if (options.baud != 0) bauds = {options.baud};
  TerminalPort port(options.device, bauds.front());
  for (const std::uint32_t baud : bauds) {
    try {
      port.set_baud(baud);
    } catch (const InputError& error) {
      print_error(error.what());
      continue;
    }
    ServoBus bus(port, baud, 4'000'000);
    for (std::uint8_t id = 0; id <= id_max; ++id) {
      ServoBus::Identity identity;
      const Answer answer = bus.ping(id, identity);
      if (answer == Answer::good) found.push_back({baud, id, identity});
      if (answer == Answer::garbage)
        print_error("at " + std::to_string(baud) + " baud something answers as " + std::to_string(id) +
                    ", but not as one servo: two may have this id");
    }
  }
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const FoundServo& servo : found)
      all.push_back({{"baud", servo.baud},
                     {"id", servo.id},
                     {"model", model_text(servo.identity.model)},
                     {"firmware", servo.identity.firmware}});
    std::puts(json_text(all).c_str());
  } else {
    for (const FoundServo& servo : found)
      std::printf("%8u baud  id %3u  %-12s firmware %u\n", servo.baud, unsigned{servo.id},
                  model_text(servo.identity.model).c_str(), unsigned{servo.identity.firmware});
  }
  if (found.empty()) print_error("no servo answers on " + options.device + ": is their supply on?");
  return found.empty() ? exit_failed : exit_passed;
}

int info(const DynamixelOptions& options) {
  Bench bench(options);
  ServoBus::Identity identity;
  bench.insist([&](ServoBus& bus) { return bus.ping(bench.id(), identity); });
  const auto signed_of = [&](Register which) { return static_cast<std::int32_t>(bench.read(which)); };
  const ServoModel* const model = find_model(identity.model);
  const std::uint32_t error = bench.read(hardware_error), torque = bench.read(torque_enable);
  const std::int32_t pulse = signed_of(present_position);
  const double volts = volt_per_unit * bench.read(present_voltage);
  const std::uint32_t celsius = bench.read(present_temperature), mode = bench.read(operating_mode);
  const std::string words = error == 0 ? "none" : std::string(hardware_error_words(error));
  if (options.json) {
    const nlohmann::ordered_json json{{"model", model_text(identity.model)},
                                      {"firmware", identity.firmware},
                                      {"hardware_error", words},
                                      {"torque", torque == 1},
                                      {"position_pulse", pulse},
                                      {"supply_V", volts},
                                      {"temperature_C", celsius},
                                      {"operating_mode", mode},
                                      {"known", model != nullptr}};
    std::puts(json_text(json).c_str());
    return exit_passed;
  }
  std::printf("%s, firmware %u%s\n", model_text(identity.model).c_str(), unsigned{identity.firmware},
              model == nullptr ? ", which Kadans does not know" : "");
  std::printf("  hardware error  %s\n  torque          %s\n  operating mode  %u\n", words.c_str(),
              torque == 1 ? "on" : "off", mode);
  std::printf("  position        %d pulses, %.4f rad from the middle\n", pulse, (pulse - 2048) * rad_per_pulse);
  std::printf("  supply          %.1f V\n  temperature     %u C\n", volts, celsius);
  std::printf("  return delay    %.3f ms\n", 1e3 * return_delay_unit_s * bench.read(return_delay));
  return exit_passed;
}

int set_id(const DynamixelOptions& options) {
  Bench bench(options);
  ServoBus::Identity other;
  if (bench.bus().ping(static_cast<std::uint8_t>(options.new_id), other) != Answer::silence)
    refuse("id " + std::to_string(options.new_id) + " on " + options.device +
           " is another servo's: connect one servo alone, or choose another id");
  bench.write(torque_enable, 0);
  bench.write(own_id, options.new_id);
  std::printf("servo %u is %u now\n", options.id, options.new_id);
  return exit_passed;
}

int set_baud(const DynamixelOptions& options) {
  const auto* const code = std::ranges::find(baud_rates, options.new_baud);
  if (code == baud_rates.end()) refuse(unknown_baud(options.new_baud));
  Bench bench(options);
  bench.write(torque_enable, 0);
  bench.write(baud_rate, static_cast<std::uint32_t>(code - baud_rates.begin()));
  std::printf("servo %u speaks at %u baud now\n", options.id, options.new_baud);
  return exit_passed;
}

int reboot(const DynamixelOptions& options) {
  Bench bench(options);
  bench.insist([&](ServoBus& bus) { return bus.reboot(bench.id()); });
  std::printf("servo %u begins anew\n", options.id);
  return exit_passed;
}

}  // namespace
}  // namespace dynamixel

void add_dynamixel(CommandLine& line) {
  CLI::App* bench = line.app.add_subcommand("dynamixel", "Find Dynamixel servos on a serial port, and set them up");
  bench->require_subcommand(1);
  const auto add = [&](const char* name, const char* doc, int (*does)(const DynamixelOptions&), bool of_one) {
    auto added = line.add<DynamixelOptions>(*bench, name, doc, does);
    added.command->add_option("device", added.options.device, "The serial port, such as /dev/ttyUSB0")
        ->required()
        ->type_name("FILE");
    if (of_one) add_whole(*added.command, "id", added.options.id, 0, dynamixel::id_max, "The servo's id")->required();
    add_whole(*added.command, "--baud", added.options.baud, 1, 10'000'000,
              "Baud rate of the servos (default: 1000000; scan tries all)");
    return added;
  };
  for (const auto& [command, options] : {add("scan", "Find the servos on a serial port", dynamixel::scan, false),
                                         add("info", "Show what one servo is and how it is", dynamixel::info, true)})
    command->add_flag("--json", options.json, "Print JSON instead of text");
  const auto set_id = add("set-id", "Give a servo another id", dynamixel::set_id, true);
  add_whole(*set_id.command, "new_id", set_id.options.new_id, 0, dynamixel::id_max, "Its new id")->required();
  const auto baud = add("baud", "Let a servo speak at another baud rate", dynamixel::set_baud, true);
  add_whole(*baud.command, "new_baud", baud.options.new_baud, 1, 10'000'000, "Its new baud rate")->required();
  add("reboot", "Let a servo begin anew, which clears its hardware error", dynamixel::reboot, true);
}

}  // namespace kadans
