// The C++ side of a control object around C code: templates of new_from_c.cpp, which says what stands for what.
#pragma once

#include <string_view>

namespace kadans {

inline constexpr std::string_view wrapped_header_template =
    R"(// Control object "@type@": runs C code made by @tool@ (code/), one step of it every @every@.
//
// What its inputs and outputs are of the robot stands in the object's options, one for each:
//
//   input    JOINT.position_rad, JOINT.velocity_rad_s, JOINT.effort_Nm  measured
//            JOINT.reference_rad, JOINT.reference_rad_s                 the joint's set-point, and its speed
//            time_s                                                     since the object took over
//            a number                                                   always that
//   output   JOINT.effort_Nm, JOINT.velocity_rad_s, JOINT.position_rad  what the joint's drive is asked for
//            signal                                                     recorded alone
//
// Parameters and signals have the names that the code's tables have.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <kadans/control/control_object.h>

extern "C" {
#include "@type@_code.h"
}

// One instance of the code. Code with variables of which a program has one, static or global, cannot have two instances
// that do not disturb each other: the second one is refused.
class @Name@Code {
 public:
  @Name@Code();  // throws std::invalid_argument
  ~@Name@Code();
  @Name@Code(const @Name@Code&) = delete;
  @Name@Code& operator=(const @Name@Code&) = delete;

  // The variables that instances would share, "" without any: found in the compiled code when this was built.
  static const char* shared_variables() noexcept;

  void initialise() noexcept;  // from the start, with these parameters
  void step(double dt_s) noexcept;

  std::array<double, @type@_inputs> inputs{};
  std::array<double, @type@_outputs> outputs{};
  std::array<double, @type@_parameters + 1> parameters{};  // one more: there may be none

 private:
  void* code_;
  double time_s_ = 0, due_s_ = 0;
};

class @Name@ final : public kadans::ControlObject {
 public:
  // Throws kadans::OptionError for an input or output that is connected to nothing or to what there is not.
  explicit @Name@(const kadans::ObjectSetup& setup);

  void declare(kadans::Declaration& declaration) override;
  void start(const kadans::ControlInput& input) noexcept override;
  void step(const kadans::ControlInput& input, kadans::ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, kadans::SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const kadans::SetpointState& state) noexcept override;
  void pass_state(kadans::StateBytes& bytes) noexcept override;

 private:
  enum class Quantity : std::uint8_t { position, velocity, effort, reference, reference_velocity, time, number, signal };
  struct Wire {
    Quantity quantity = Quantity::number;
    std::size_t joint = 0, axis = 0;
    double number = 0;
  };
  struct Axis {
    std::size_t joint;
    std::string name;
    double lower_rad, upper_rad;
    bool led = false;  // an input is its reference
    kadans::SetpointState reference{};
  };
  Wire wire_of(const std::string& name, const kadans::ObjectSetup& setup, bool output);

  @Name@Code code_;
  std::vector<Axis> axes_;
  std::vector<Wire> inputs_, outputs_;
  double time_s_ = 0;
};

std::unique_ptr<kadans::ControlObject> make_@type@(const kadans::ObjectSetup& setup);
)";

inline constexpr std::string_view wrapped_source_template = R"(#include "@type@.h"

#include <algorithm>
#include <charconv>
#include <mutex>
#include <stdexcept>

#include "@type@_state.h"

using namespace kadans;

namespace {

struct Row {
  const char* name;
  const char* unit;
  double min, max;  // of parameters: the code's tables know no range, so narrow these
  const char* doc;
};
constexpr Row input_rows[] = {
@input_rows@};
constexpr Row output_rows[] = {
@output_rows@};
constexpr Row parameter_rows[] = {
@parameter_rows@    {nullptr, nullptr, 0, 0, nullptr}};

constexpr double period_s = @period@;  // 0: each step is as long as the object's tick
bool one_exists = false;
std::mutex one_exists_guard;

}  // namespace

@Name@Code::@Name@Code() {
  const std::lock_guard lock(one_exists_guard);
  if (*shared_variables() != 0 && one_exists)
    throw std::invalid_argument(
        std::string("the C code of @type@ keeps its state in variables of which a program has one (") + shared_variables() +
        "): two objects of the type would disturb each other, so there can be one");
  code_ = @type@_make();
  if (code_ == nullptr) throw std::invalid_argument("the C code of @type@ does not start");
  one_exists = true;
  @type@_initialise(code_, parameters.data(), 1);
}

@Name@Code::~@Name@Code() {
  const std::lock_guard lock(one_exists_guard);
  @type@_free(code_);
  one_exists = false;
}

const char* @Name@Code::shared_variables() noexcept { return shared_state; }

void @Name@Code::initialise() noexcept {
  @type@_initialise(code_, parameters.data(), 0);
  time_s_ = due_s_ = 0;
}

// Between two steps of the code its outputs hold; where they are shorter than a tick, several are made in it, but not
// without bound: what a long tick leaves beyond that is not made up for.
void @Name@Code::step(double dt_s) noexcept {
  constexpr int steps_max = 16;
  const double step_s = period_s > 0 ? period_s : dt_s;
  for (int made = 0; made < steps_max && due_s_ < 0.5 * std::min(step_s, dt_s); ++made) {
    @type@_step(code_, time_s_, step_s, inputs.data(), outputs.data(), parameters.data());
    time_s_ += step_s;
    due_s_ += step_s;
  }
  due_s_ = std::max(due_s_ - dt_s, -steps_max * step_s);
}

@Name@::@Name@(const ObjectSetup& setup) {
  for (const std::size_t index : setup.joints) {
    const Joint& joint = setup.model.joints.at(index);
    if (joint.passive()) throw std::invalid_argument("joint " + joint.name + " has no motor");
    axes_.push_back({index, joint.name, std::max(joint.lower_rad, -1e6), std::min(joint.upper_rad, 1e6)});
  }
  for (const Row& row : input_rows) inputs_.push_back(wire_of(row.name, setup, false));
  for (const Row& row : output_rows) outputs_.push_back(wire_of(row.name, setup, true));
  for (const Axis& axis : axes_) {
    const auto drives = [&](const Wire& wire) {
      return wire.quantity != Quantity::signal && wire.joint == axis.joint;
    };
    if (std::count_if(outputs_.begin(), outputs_.end(), drives) != 1)
      throw std::invalid_argument("joint " + axis.name + " must be driven by one output of the C code, such as \"" +
                                  output_rows[0].name + "\": \"" + axis.name + ".effort_Nm\" in options");
  }
}

@Name@::Wire @Name@::wire_of(const std::string& name, const ObjectSetup& setup, bool output) {
  const std::string* const text = setup.options.find(name);
  const std::string all = output ? "JOINT.effort_Nm, JOINT.velocity_rad_s, JOINT.position_rad or signal"
                                 : "JOINT.position_rad, JOINT.velocity_rad_s, JOINT.effort_Nm, JOINT.reference_rad, "
                                   "JOINT.reference_rad_s, time_s or a number";
  if (text == nullptr)
    throw OptionError(name, std::string(output ? "output" : "input") + " '" + name + "' of the C code is connected to nothing: \"" +
                                name + "\" in options must be " + all);
  if (output && *text == "signal") return {.quantity = Quantity::signal};
  if (!output && *text == "time_s") return {.quantity = Quantity::time};
  Wire wire;
  const char* const end = text->data() + text->size();
  if (!output && std::from_chars(text->data(), end, wire.number).ptr == end && !text->empty()) return wire;
  const std::size_t dot = text->rfind('.');
  const std::string joint = text->substr(0, dot), what = dot == std::string::npos ? "" : text->substr(dot + 1);
  const auto axis = std::find_if(axes_.begin(), axes_.end(), [&](const Axis& one) { return one.name == joint; });
  if (axis == axes_.end()) throw OptionError(name, "'" + *text + "': the object has no joint '" + joint + "'; it must be " + all);
  wire.joint = axis->joint;
  wire.axis = static_cast<std::size_t>(axis - axes_.begin());
  if (what == "position_rad") {
    wire.quantity = Quantity::position;
  } else if (what == "velocity_rad_s") {
    wire.quantity = Quantity::velocity;
  } else if (what == "effort_Nm") {
    wire.quantity = Quantity::effort;
  } else if (!output && what == "reference_rad") {
    wire.quantity = Quantity::reference;
    axis->led = true;
  } else if (!output && what == "reference_rad_s") {
    wire.quantity = Quantity::reference_velocity;
    axis->led = true;
  } else {
    throw OptionError(name, "'" + *text + "' must be " + all);
  }
  return wire;
}

void @Name@::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < @type@_parameters; ++i) {
    const Row& row = parameter_rows[i];
    double& value = code_.parameters[i];
    declaration.parameter({.name = row.name, .unit = row.unit, .min = std::min(row.min, value), .max = std::max(row.max, value),
                           .initial = value, .doc = row.doc},
                          &value);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    if (!axis.led) continue;
    declaration.setpoint({.name = axis.name + ".position_rad", .unit = "rad", .min = axis.lower_rad, .max = axis.upper_rad,
                          .doc = "Where the joint shall be.", .channel = static_cast<std::uint32_t>(i),
                          .joint = static_cast<std::uint32_t>(axis.joint)});
    declaration.signal({axis.name + ".reference_rad", "rad", "Set-point of the position."}, &axis.reference.value);
  }
  for (std::size_t i = 0; i < @type@_inputs; ++i)
    declaration.signal({std::string("in.") + input_rows[i].name, input_rows[i].unit, input_rows[i].doc}, &code_.inputs[i]);
  for (std::size_t i = 0; i < @type@_outputs; ++i)
    declaration.signal({std::string("out.") + output_rows[i].name, output_rows[i].unit, output_rows[i].doc}, &code_.outputs[i]);
}

// The code begins anew where the joints are; what is left of a step in torque the framework fades out.
void @Name@::start(const ControlInput& input) noexcept {
  for (Axis& axis : axes_)
    axis.reference = {.value = std::clamp(input.joints.joints[axis.joint].position_rad, axis.lower_rad, axis.upper_rad)};
  code_.initialise();
  time_s_ = 0;
}

void @Name@::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Wire& wire = inputs_[i];
    const JointState& joint = input.joints.joints[wire.joint];
    double& value = code_.inputs[i];
    switch (wire.quantity) {
      case Quantity::position: value = joint.position_rad; break;
      case Quantity::velocity: value = joint.velocity_rad_s; break;
      case Quantity::effort: value = joint.effort_Nm; break;
      case Quantity::reference: value = axes_[wire.axis].reference.value; break;
      case Quantity::reference_velocity: value = axes_[wire.axis].reference.velocity; break;
      case Quantity::time: value = time_s_; break;
      case Quantity::number:
      case Quantity::signal: value = wire.number; break;
    }
  }
  code_.step(input.dt_s);
  time_s_ += input.dt_s;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Wire& wire = outputs_[i];
    const double value = code_.outputs[i];
    if (wire.quantity == Quantity::signal) continue;
    JointActuation& joint = actuation.joints[wire.joint];
    if (wire.quantity == Quantity::effort) joint = {.effort_Nm = value, .mode = ActuationMode::effort};
    if (wire.quantity == Quantity::velocity) joint = {.velocity_rad_s = value, .mode = ActuationMode::velocity};
    if (wire.quantity == Quantity::position) joint = {.position_rad = value, .mode = ActuationMode::position};
  }
}

bool @Name@::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  return state = axes_[channel].reference, true;
}

void @Name@::follow(std::uint32_t channel, const SetpointState& state) noexcept { axes_[channel].reference = state; }

// What is seen of the code; what it hides shows in its outputs.
void @Name@::pass_state(StateBytes& bytes) noexcept {
  for (Axis& axis : axes_) bytes(axis.reference);
  bytes(code_.inputs, code_.outputs, time_s_);
}

std::unique_ptr<ControlObject> make_@type@(const ObjectSetup& setup) { return std::make_unique<@Name@>(setup); }
)";

inline constexpr std::string_view wrapped_test_template = R"(#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "@type@.h"

#include <cmath>
#include <cstring>

#include <kadans/testing/doctest.h>

using namespace kadans::testing;

namespace {

// Inputs that change, the same for the same number.
void drive(@Name@Code& code, int number) {
  for (std::size_t i = 0; i < code.inputs.size(); ++i)
    code.inputs[i] = 0.1 * std::sin(0.05 * number * static_cast<double>(i + 1));
  code.step(0.001);
}

std::vector<double> outputs_alone(int steps) {
  @Name@Code code;
  std::vector<double> all;
  for (int i = 0; i < steps; ++i) {
    drive(code, i);
    all.insert(all.end(), code.outputs.begin(), code.outputs.end());
  }
  return all;
}

}  // namespace

TEST_CASE("The C code of @type@ gives numbers, and the same ones when it begins anew") {
  const std::vector<double> first = outputs_alone(500);
  for (const double value : first) REQUIRE(std::isfinite(value));
  CHECK(outputs_alone(500) == first);
  @Name@Code code;
  for (int i = 0; i < 77; ++i) drive(code, i);
  code.initialise();
  std::vector<double> again;
  for (int i = 0; i < 500; ++i) {
    drive(code, i);
    again.insert(again.end(), code.outputs.begin(), code.outputs.end());
  }
  CHECK(again == first);
}

TEST_CASE("The C code of @type@ does not allocate, neither when it begins nor in its steps") {
  @Name@Code code;
  const AllocationCount heap;
  code.initialise();
  for (int i = 0; i < 200; ++i) drive(code, i);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("Two instances of the C code of @type@ do not share state, or the second one is refused") {
  @Name@Code code;
  const std::string shared = @Name@Code::shared_variables();
  if (!shared.empty()) {
    CHECK_THROWS_AS(@Name@Code(), std::invalid_argument);
    return;
  }
  const std::vector<double> alone = outputs_alone(500);
  @Name@Code other;
  std::vector<double> beside;
  for (int i = 0; i < 500; ++i) {
    drive(code, i);
    beside.insert(beside.end(), code.outputs.begin(), code.outputs.end());
    drive(other, 3 * i + 1);
  }
  CHECK(beside == alone);
}
)";

}  // namespace kadans
