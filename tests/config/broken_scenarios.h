// Scenarios that are right_scenario broken in one place, each with the message that it must give.
#pragma once

#include "broken.h"

namespace kadans {

inline constexpr Broken broken_scenarios[] = {
    {"\"name\": \"stand\"", "\"nam\": \"stand\"",
     "1:1: key 'name' is missing: the scenario's name\n2:3: unknown key 'nam', did you mean 'name'?"},
    {"\"robot\": \"config/tulip/robot.json\"", "\"robot\": \"config/tulip/robto.json\"",
     "3:12: robot: there is no file 'config/tulip/robto.json' in ROOT, did you mean 'robot.json'?"},
    {"\"robot\": \"config/tulip/robot.json\"", "\"robot\": [\"config/tulip/robot.json\"]",
     "3:12: robot must be a string, not an array: the robot's configuration, from the project root"},
    {"\"robot\": \"config/tulip/robot.json\"", "\"robot\": \"a\\u0000b\"", "3:12: robot: 'a?b' is no path"},
    {"\"plant\": \"bullet\"", "\"plant\": \"bulet\"", "4:12: plant: unknown value 'bulet', did you mean 'bullet'?"},
    {"\"plant\": \"bullet\"", "\"plant\": \"mujoco\"", "4:12: plant: unknown value 'mujoco' (known: bullet, ideal)"},
    {"\"plant\": \"bullet\"", "\"plant\": false", "4:12: plant must be a string, not false: what plays the robot"},
    {"\"plant\": \"bullet\"", "\"bus\": {}",
     "4:10: key 'type' is missing in bus: the bus, as `kadans run --plant` names it; "
     "where its drives are stands in the robot's configuration"},
    {"\"duration_s\": 2.5", "\"duration\": 2.5",
     "1:1: key 'duration_s' is missing: duration of the simulation\n5:3: unknown key 'duration', did you mean "
     "'duration_s'?"},
    {"\"duration_s\": 2.5", "\"duration_s\": 0",
     "5:17: duration_s is 0, must be 0.001..1000000 s: duration of the simulation"},
    {"\"duration_s\": 2.5", "\"duration_s\": 2,5",
     "5:19: a key in double quotes is needed here, not '5' (decimals are written with a point)"},
    {"\"duration_s\": 2.5", "\"duration_s\": NaN", "5:17: 'NaN' is no JSON number, leave the key out"},
    {"\"seed\": 7", "\"seed\": -7",
     "6:11: seed is -7, must be 0..18446744073709551615: seed of all random numbers of the run"},
    {"\"seed\": 7", "\"seed\": 18446744073709551616",
     "6:11: seed is 18446744073709551616, must be 0..18446744073709551615, a whole number: seed of all random numbers "
     "of the run"},
    {"\"seed\": 7", "\"seed\": 0.5",
     "6:11: seed is 0.5, must be 0..18446744073709551615, a whole number: seed of all random numbers of the run"},
    {"\"models/tulip/tulip.urdf\"", "\"behaviors/tulip/no_such_behavior.lua\"",
     "7:18: behavior: there is no file 'behaviors/tulip/no_such_behavior.lua' in ROOT"},
    {"\"models/tulip/tulip.urdf\"", "true",
     "7:17: behaviors[0] must be a string, not true: what to play, one after the other: files, or "
     "\"squat{depth_m=0.08}, wave\""},
    {"\"kind\": \"always\"", "\"kind\": \"allways\"",
     "9:34: checks[0].kind: unknown value 'allways', did you mean 'always'?"},
    {"\"kind\": \"always\", ", "",
     "9:5: key 'kind' is missing in checks[0]: when the condition must hold (never: must not hold)"},
    {"\"max\": 0.05", "\"max\": \"0.05\"",
     "9:78: checks[0].max must be a number, not the string '0.05': greatest value, in the signal's unit"},
    {", \"max\": 0.05", "", "9:5: checks[0] needs min, max or both"},
    {"\"min\": 0.7, \"max\": 0.9", "\"min\": 0.9, \"max\": 0.7",
     "10:87: checks[1].max is 0.7, must be at least min, 0.9"},
    {"\"until_s\": 2", "\"until_s\": 0.5", "11:106: checks[2].until_s is 0.5, must be at least from_s, 1 s"},
    {"\"from_s\": 1, \"until_s\": 2", "\"from_s\": 3", "11:92: checks[2].from_s is 3, the scenario ends at 2.5 s"},
    {"\"kind\": \"never\"", "\"kind\": \"at_end\"",
     "11:93: checks[2] is judged at the end, from_s and until_s mean nothing here"},
    {"\"name\": \"tall\"", "\"name\": \"upright\"", "10:15: checks[1].name: another check is named 'upright'"},
    {"\"min\": 1,", "\"mni\": 1,",
     "11:5: checks[2] needs min, max or both\n11:72: unknown key 'mni' in checks[2], did you mean 'min'?"},
    {"\"min\": 1,", "\"min\": 1, \"that\": \"x > 1\",",
     "11:5: checks[2] has both signal and that, must have one of them"},
    {"\"kind\": \"never\"", "\"kind\": \"within\"",
     "11:5: checks[2] is of kind 'within' and needs when\n11:5: checks[2] is of kind 'within' and needs within_s"},
    {"\"kind\": \"always\"", "\"kind\": \"settles\"", "9:5: checks[0] is of kind 'settles' and needs within_s"},
    {"\"max\": 0.05", "\"max\": 0.05, \"when\": \"x > 1\"",
     "9:92: checks[0].when means nothing to a check of kind 'always'"},
    {"\"checks\": [", "\"checks\": [ 5,", "8:15: checks[0] must be an object, not the number 5: checks that must hold"},
    {"\"seed\": 7", "\"seed\": 7, \"joystick\": { \"recording\": \"config/joystick/no.evemu\" }",
     "6:41: recording: there is no file 'config/joystick/no.evemu' in ROOT"},
};

}  // namespace kadans
