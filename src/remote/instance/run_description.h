// Describes a run for viewers as one JSON text: the robot's name and feet, control sets with their objects, parameters
// with unit and range, the objects of the world as balls and boxes, the ground with its slope and markings, payloads,
// and the charts of the behaviors. Their states have the same numbers as the signal behavior.<name>.state. A record and
// a live server send the text on /description. Whoever draws the world draws it from here and from the signals.
//
// It is made from the tables; this code knows no concrete control object or behavior.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "config/robot/robot_config.h"
#include "kadans/control/catalog.h"
#include "script/behavior/behavior_why.h"
#include "script/host/script_host.h"
#include "telemetry/record/record_writer.h"

namespace kadans {

// The texts about a robot that viewers need before the first value.
struct RobotTexts {
  std::string name, urdf;
  std::string description;
  struct Other {
    std::string name, urdf, file;  // the file of the URDF
  };
  std::vector<Other> others{};  // the further robots of the world
};

// An event that a behavior declares: {name, doc, fields: [{name, type, unit, doc, min, max, optional}]}.
nlohmann::ordered_json event_json(const ScriptEvent& event);
// {file, line, text}
nlohmann::ordered_json guard_json(const GuardSource& guard);
// Writes the texts that there are into a record that has just been opened.
void describe_robots(RecordWriter& record, const RobotTexts& texts, std::int64_t time_ns);

// Call it before the loop or between two behavior ticks, because it reads the values of parameters and the charts.
// Without a host (behaviors in a process of their own) the charts are left out.
// `called`: the robot's name in its world, where it has another one than in its configuration; "": it has not.
std::string run_description(const RobotConfig& robot, const std::string& called, const Catalog& catalog,
                            const ScriptHost* host, const WorldSettings& world);
// The array "behaviors" of that text alone, which changes when other behaviors or new versions play. Call it between
// two behavior ticks.
std::string behaviors_description(const ScriptHost* host);

}  // namespace kadans
