// The examples at the end of each command's --help. They use files of the project and files that earlier examples have
// written.
#include <algorithm>
#include <string_view>

#include "app/command_line.h"
#include "remote/order/order.h"

namespace kadans {
namespace {

struct Examples {
  std::string_view words;  // of the command or group; "": the program
  const char* text;
};

constexpr Examples all_examples[] = {
    {"",
     "  kadans sim config/scenarios/squat.json             run a scenario, read what happened\n"
     "  kadans sim config/scenarios/squat.json --json      the same as one JSON object\n"
     "  kadans test push --jobs 2                          run all scenarios tagged push, two at a time\n"
     "  kadans replay squat.mcap                           run a record again, and report where it differs\n"
     "  kadans repl config/scenarios/squat.json            look into a simulation, and command it\n"
     "  kadans run config/tulip/robot.json --play squat    drive the robot, or its model, on the wall clock\n"
     "  kadans view squat.mcap                             show a record in the browser: robot, plots, states\n"
     "  kadans log info squat.mcap                         what a record holds; also cat, csv, plot, diff, cut\n"
     "  kadans ctl status                                  the state of a running robot; see 'kadans ctl --help'\n"
     "  kadans check behaviors config                      report mistakes in files, without running them\n"
     "  kadans new control-object knee_damper              write a control object with its test, ready to build\n"},
    {"sim",
     "  kadans sim config/scenarios/squat.json                       writes squat.mcap\n"
     "  kadans sim config/scenarios/squat.json --seed 7 --duration 5 --no-record\n"
     "  kadans sim config/scenarios/squat.json --set ground.friction=0.3 --play 'squat{depth_m=0.08}, wave'\n"
     "  kadans sim config/scenarios/squat.json --checkpoint 2.5=later.mcap\n"
     "  kadans sim --from later.mcap --push torso=0,1,0              continue with a push\n"
     "  kadans sim config/scenarios/squat.json --live --speed 0.5    in the browser\n"},
    {"test",
     "  kadans test                                all of config/scenarios, one a core\n"
     "  kadans test push 'squat*' --jobs 2         by tag and by name\n"
     "  kadans test push --list                    what would run\n"
     "  kadans test --rerun-failed                 what failed the last time\n"
     "  kadans test --golden --junit results.xml   for CI\n"},
    {"replay",
     "  kadans replay squat.mcap                  with the files as they are now\n"
     "  kadans replay squat.mcap --from-record    with those in the record: has the program changed?\n"},
    {"debug",
     "  kadans debug config/scenarios/get_up_prone.json               what an editor starts: docs/debugging.md\n"
     "  kadans debug fall.mcap --port 4711                            a record, for an editor that connects\n"},
    {"check",
     "  kadans check behaviors/tulip/squat.lua config/tulip/robot.json\n"
     "  kadans check config/scenarios              every file in it, with the behaviors that are played there\n"
     "  kadans check 'behaviors/*/stand*.lua'\n"
     "  kadans check behaviors/lib --robot config/tulip/robot.json\n"},
    {"sweep",
     "  kadans sweep config/sweeps/push_varied.json --cases 4 --out part\n"
     "  kadans sweep config/sweeps/push_varied.json --shard 0/4    a quarter, on each of four machines\n"},
    {"merge",
     "  kadans merge part --csv push.csv\n"
     "  kadans merge part --heat-map push.svg --x ground.friction --y link.torso.mass_scale\n"},
    {"margin",
     "  kadans margin config/tulip/robot.json config/scenarios/squat.json --quantity delay\n"
     "  kadans margin config/tulip/robot.json config/scenarios/squat.json --quantity "
     "'joint.*_knee.torque_scale=0.02'\n"},
    {"shrink",
     "  kadans shrink config/scenarios/weak_knees.json --set 'joint.*_knee.torque_scale=0.2'\n"
     "  kadans shrink sweeps/push_varied-0123abcd --case 3 --out least.json    a case of a sweep that failed\n"},
    {"tune",
     "  kadans tune config/tuning/squat_height.json --generations 2 --runs 1 --out tuned\n"
     "  kadans tune config/tuning/squat_height.json --write better.json --overwrite\n"},
    {"behavior", "  kadans behavior check behaviors\n"},
    {"behavior check",
     "  kadans behavior check behaviors/tulip/squat.lua\n"
     "  kadans behavior check behaviors                a folder, with its library and tests\n"},
    {"behavior test",
     "  kadans behavior test behaviors/tulip/squat_test.lua\n"
     "  kadans behavior test behaviors --only squat      what has that in its name\n"
     "  kadans behavior test behaviors/lib --junit results.xml\n"},
    {"behavior graph",
     "  kadans behavior graph behaviors/tulip/squat.lua\n"
     "  kadans behavior graph behaviors/tulip/squat.lua --format dot\n"},
    {"repl",
     "  kadans repl config/scenarios/squat.json\n"
     "  printf 'signals.plant.base.height_m\\n:run 3\\nbehaviors.squat.state\\n' | kadans repl "
     "config/scenarios/squat.json\n"},
    {"lua-stubs",
     "  kadans lua-stubs --robot config/tulip/robot.json --output behaviors\n"
     "  kadans lua-stubs --markdown\n"},
    {"params",
     "  kadans params behaviors/tulip/squat.lua\n"
     "  kadans params config/tulip/robot.json --json\n"},
    {"run",
     "  kadans run config/tulip/robot.json --play squat                the model, until Ctrl-C\n"
     "  kadans run config/tulip/robot.json --soft --duration 10 --record walk.mcap\n"
     "  kadans run config/tulip/robot.json --play squat --live         in the browser\n"
     "  kadans run config/jiwiy/robot.json --play stick --joystick /dev/input/event5\n"
     "  kadans run config/tulip/robot.json --plant udp --peer robot:7100\n"
     "  kadans run config/jiwiy/anything_io.json --plant hm2-eth --read-only    what the sensors say, without "
     "torque\n"},
    {"jog",
     "  kadans jog config/jiwiy/robot.json pan\n"
     "  kadans jog config/jiwiy/anything_io.json pan --plant hm2-eth --share 0.05\n"},
    {"commission",
     "  kadans commission config/jiwiy/anything_io.json\n"
     "  kadans commission config/jiwiy/servos.json pan --steps names,direction --share 0.05\n"},
    {"plant",
     "  kadans plant config/tulip/robot.json --listen :7100\n"
     "  kadans plant config/scenarios/side_by_side.json --listen :7100 --listen :7101\n"
     "  kadans plant config/jiwiy/servos.json --as dynamixel --listen /tmp/bus\n"},
    {"dynamixel",
     "  kadans dynamixel scan /dev/ttyUSB0\n"
     "  kadans dynamixel set-id /dev/ttyUSB0 1 7 --baud 57600\n"},
    {"dynamixel scan",
     "  kadans dynamixel scan /dev/ttyUSB0\n"
     "  kadans dynamixel scan /tmp/bus --baud 3000000\n"},
    {"dynamixel info", "  kadans dynamixel info /dev/ttyUSB0 7 --baud 3000000\n"},
    {"dynamixel set-id", "  kadans dynamixel set-id /dev/ttyUSB0 1 7 --baud 57600\n"},
    {"dynamixel baud", "  kadans dynamixel baud /dev/ttyUSB0 7 3000000 --baud 57600\n"},
    {"dynamixel reboot", "  kadans dynamixel reboot /dev/ttyUSB0 7\n"},
    {"jitter",
     "  kadans jitter --seconds 10\n"
     "  kadans jitter --load --svg jitter.svg\n"},
    {"ctl",
     "  kadans ctl status\n"
     "  kadans ctl watch joint.l_knee.position_rad safety.level\n"
     "  kadans ctl set posture.l_knee.kp_Nm_per_rad 250\n"
     "  kadans ctl --host kadans@robot.local status\n"},
    {"push",
     "  kadans push kadans@robot.local config/tulip/robot.json\n"
     "  kadans push kadans@robot.local --tested          in a project of one robot\n"
     "  kadans push kadans@robot.local --undo\n"},
    {"ctl drive", "  kadans ctl drive enable\n"},
    {"ctl fault", "  kadans ctl fault list\n"},
    {"ctl record", "  kadans ctl record start walk.mcap\n"},
    {"ctl repl", "  kadans ctl repl\n"},
    {"completion",
     "  kadans completion zsh\n"
     "  eval \"$(kadans completion bash)\"    in ~/.bashrc; an installed program's is in its place already\n"},
    {"view", "  kadans view squat.mcap\n"},
    {"render",
     "  kadans render squat.mcap --at 3.2\n"
     "  kadans render squat.mcap --film -o squat.png\n"},
    {"log",
     "  kadans log info squat.mcap\n"
     "  kadans log plot squat.mcap plant.base.height_m 'joint.*_knee.effort_Nm' -o squat.svg\n"},
    {"log info", "  kadans log info squat.mcap --json\n"},
    {"log cat", "  kadans log cat squat.mcap --topic transitions --topic log --from 2 --to 4\n"},
    {"log csv", "  kadans log csv squat.mcap 'joint.*knee.*' --every 0.01 -o knees.csv\n"},
    {"log observations", "  kadans log observations fetch.mcap -o ball.csv\n"},
    {"log plot",
     "  kadans log plot squat.mcap plant.base.height_m\n"
     "  kadans log plot squat.mcap plant.base.height_m 'joint.*_knee.effort_Nm' -o squat.svg\n"},
    {"log diff", "  kadans log diff squat.mcap again.mcap --tolerance 1e-9\n"},
    {"log cut", "  kadans log cut squat.mcap --from 2 --to 4 --signals 'joint.*' -o short.mcap\n"},
    {"doctor",
     "  kadans doctor\n"
     "  kadans doctor config/jiwiy/servos.json\n"},
    {"new",
     "  kadans new robot models/jiwiy/jiwiy.urdf --name camera --in mine\n"
     "  kadans new behavior nod --robot config/jiwiy/robot.json\n"
     "  kadans new control-object knee_damper\n"},
    {"new behavior", "  kadans new behavior nod --robot config/jiwiy/robot.json\n"},
    {"new scenario",
     "  kadans new scenario nudged --robot config/jiwiy/robot.json\n"
     "  kadans new scenario sines --robot config/jiwiy/robot.json --play sine\n"},
    {"new sweep", "  kadans new sweep switched --scenario config/scenarios/jiwiy_switched.json\n"},
    {"new plant", "  kadans new plant can_drives --robot config/jiwiy/robot.json\n"},
    {"new robot",
     "  kadans new robot models/jiwiy/jiwiy.urdf --name camera --in mine\n"
     "  kadans new robot models/head/head.urdf --name eyes --no-run\n"},
    {"new control-object",
     "  kadans new control-object knee_damper\n"
     "  kadans new control-object knee_damper --plugin --in plugins\n"},
};

constexpr const char* program_end =
    "\nResults go to stdout, progress and errors to stderr.\n"
    "Exit codes: 0 passed, 1 failed, 2 wrong usage or input, 3 internal error, 130 interrupted.\n";

// Those of an order stand in the table of orders.
std::string order_examples(const std::string& words) {
  for (const OrderInfo& order : order_table::orders) {
    if (words != std::string("ctl ") + order.words) continue;
    return order.examples[0] != 0 ? order.examples : "  kadans " + words + "\n";
  }
  return "";
}

void add_below(CLI::App& app, const std::string& words) {
  const auto* const found = std::ranges::find(all_examples, words, &Examples::words);
  const std::string own = app.get_footer();
  const std::string text = found == std::end(all_examples) ? order_examples(words) : found->text;
  std::string end = text.empty() ? "" : "Examples:\n" + text;
  if (words.empty()) end += program_end;
  const std::vector<CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
  for (CLI::App* command : commands) add_below(*command, words + (words.empty() ? "" : " ") + command->get_name());
  app.footer(end + (own.empty() ? "" : "\n" + own + "\n"));
}

}  // namespace

void add_examples(CLI::App& app) { add_below(app, ""); }

}  // namespace kadans
