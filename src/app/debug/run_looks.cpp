// What is asked about the run while it stands still: in a copy of its process, which is dropped afterwards.
#include "debugged_run.h"
#include "kadans/control/catalog.h"
#include "script/behavior/behavior.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

Json variable(const ShownValue& value, int base) {
  return {{"name", value.name},
          {"value", value.text},
          {"type", value.type},
          {"variablesReference", value.fields == 0 ? 0 : base + static_cast<int>(value.fields)}};
}

Json number_variable(const std::string& name, double value, const std::string& unit) {
  return {{"name", name},
          {"value", printed("%.10g", value) + (unit.empty() ? "" : " " + unit)},
          {"type", "number"},
          {"variablesReference", 0}};
}

Json mistake(const std::string& text) { return {{"error", text}}; }

}  // namespace

Inspection& DebuggedRun::inspection(int behavior) {
  std::unique_ptr<Inspection>& one = inspections_[behavior];
  if (!one) {
    Behavior& shown = *behaviors_.at(static_cast<std::size_t>(behavior)).second;
    one = std::make_unique<Inspection>(shown, state_ != nullptr && plays_in(shown, state_) ? state_ : nullptr);
  }
  return *one;
}

Json DebuggedRun::look(const Json& order) {
  const std::string what = order.value("what", "");
  if (inspections_.empty()) collect_behaviors();
  if (what == "threads") return threads();
  if (what == "frames") return frames(order.value("thread", 0));
  if (what == "scopes") return scopes(order.value("frame", 0));
  if (what == "fields") return fields(order.value("number", 0));
  return evaluate(order.value("frame", 0), order.value("text", ""));
}

Json DebuggedRun::threads() {
  Json all = Json::array({{{"id", run_thread}, {"name", assembly_.robot().model.name}}});
  int id = first_behavior_thread;
  for (const auto& [name, behavior] : behaviors_) {
    if (!behavior->finished() && !behavior->failed()) all.push_back({{"id", id}, {"name", name}});
    ++id;
  }
  return {{"threads", all}};
}

Json DebuggedRun::frames(int thread) {
  Json all = Json::array();
  const int behavior = thread - first_behavior_thread;
  if (behavior >= 0 && behavior < static_cast<int>(behaviors_.size())) {
    int id = frames_of_behavior * (behavior + 1);
    for (const ShownFrame& frame : inspection(behavior).frames()) {
      all.push_back({{"id", id++},
                     {"name", frame.name},
                     {"chunk", frame.chunk},
                     {"line", frame.line},
                     {"of_chart", frame.of_chart}});
    }
  } else if (thread == run_thread) {
    const std::string when = printed(", %.3f s", 1e-9 * static_cast<double>(time_ns_));
    all.push_back({{"id", run_frame}, {"name", "tick " + std::to_string(now_.tick) + when}, {"line", 0}});
  }
  return {{"frames", all}};
}

Json DebuggedRun::scopes(int frame) {
  Json all = Json::array();
  if (frame == run_frame) {
    all.push_back({{"name", "signals"}, {"variablesReference", signals_number}, {"expensive", true}});
    all.push_back({{"name", "parameters"}, {"variablesReference", parameters_number}, {"expensive", true}});
    return {{"scopes", all}};
  }
  const int behavior = frame / frames_of_behavior - 1;
  if (behavior < 0 || behavior >= static_cast<int>(behaviors_.size())) return mistake("there is no such frame");
  for (const ShownValue& one : inspection(behavior).scopes(static_cast<std::size_t>(frame % frames_of_behavior))) {
    Json scope = variable(one, numbers_of_behavior * (behavior + 1));
    scope["expensive"] = one.name == "s";
    if (one.name == "locals" || one.name == "args")
      scope["presentationHint"] = one.name == "args" ? "arguments" : "locals";
    all.push_back(std::move(scope));
  }
  return {{"scopes", all}};
}

Json DebuggedRun::fields(int number) {
  Json all = Json::array();
  const Catalog& catalog = assembly_.catalog();
  if (number == signals_number) {
    const std::span<const double> row = assembly_.control().row();
    for (std::size_t i = 0; i < row.size() && i < catalog.signals.size(); ++i) {
      const auto& info = catalog.signals.info(static_cast<SignalId>(i));
      all.push_back(number_variable(info.name, row[i], info.unit));
    }
  } else if (number == parameters_number) {
    for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
      const Parameter& info = catalog.parameters.info(id);
      all.push_back(number_variable(info.name, catalog.parameters.get(id), info.unit));
    }
  } else if (const int behavior = number / numbers_of_behavior - 1;
             behavior >= 0 && behavior < static_cast<int>(behaviors_.size())) {
    for (const ShownValue& one : inspection(behavior).fields(static_cast<std::uint32_t>(number % numbers_of_behavior)))
      all.push_back(variable(one, numbers_of_behavior * (behavior + 1)));
  } else {
    return mistake("nothing is shown under the number " + std::to_string(number));
  }
  return {{"variables", all}};
}

Json DebuggedRun::evaluate(int frame, const std::string& text) {
  int behavior = frame / frames_of_behavior - 1;
  if (frame == 0) behavior = behavior_;
  if (behavior < 0) return evaluate_signals(text);
  if (behavior >= static_cast<int>(behaviors_.size())) return mistake("there is no such frame");
  ShownValue value;
  const bool well = inspection(behavior).evaluate(static_cast<std::size_t>(frame % frames_of_behavior), text, value);
  if (!well) return mistake(value.text);
  return variable(value, numbers_of_behavior * (behavior + 1));
}

// As a check of a scenario has it: "plant.base.height_m * 100".
Json DebuggedRun::evaluate_signals(const std::string& text) const {
  std::string wrong;
  for (const auto gives : {SignalExpressions::Gives::number, SignalExpressions::Gives::condition}) {
    SignalExpressions expressions(assembly_.catalog().signals, assembly_.signal_states());
    std::size_t index = 0;
    ExpressionError error;
    if (!expressions.add(text, index, error, gives)) return mistake(error.message);
    if (!expressions.evaluate(1e-9 * static_cast<double>(time_ns_), assembly_.control().row())) {
      wrong = expressions.error();
      continue;
    }
    const double value = expressions.value(index);
    if (gives == SignalExpressions::Gives::number) return number_variable(text, value, "");
    return {{"value", value != 0 ? "true" : "false"}, {"type", "boolean"}, {"variablesReference", 0}};
  }
  return mistake(wrong);
}

}  // namespace kadans
