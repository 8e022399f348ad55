#include "robot_description.h"

#include <system_error>

#include "kadans/signal/input_error.h"
#include "realtime/machine/child_process.h"
#include "signal/input_file.h"
#include "signal/shell_word.h"

namespace kadans {
namespace {

constexpr std::size_t urdf_max_bytes = std::size_t{16} << 20U;

std::string expanded_xacro(const std::filesystem::path& file) {
  check_input_file(file);
  const auto fail = [&](const std::string& message) { throw InputError({.file = file.string(), .message = message}); };
  ProgramOutput output;
  try {
    output = run_program({"xacro", std::filesystem::absolute(file).string()});
  } catch (const std::system_error&) {
    const std::string name = shell_word(file.string());
    const std::string urdf = shell_word(std::filesystem::path(file).replace_extension().replace_extension(".urdf"));
    fail("is xacro, which the program xacro expands, and that is not installed here: where ROS is, 'xacro " + name +
         " > " + urdf + "'; elsewhere 'pip install xacro' brings it");
  }
  if (output.exit_code != 0) {
    const std::size_t end = output.err.find_last_not_of("\r\n");
    const std::string said = end == std::string::npos ? "nothing" : output.err.substr(0, end + 1);
    fail("xacro could not expand it, and says:\n" + said);
  }
  return output.out;
}

}  // namespace

bool is_robot_description(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".urdf" || extension == ".URDF") return true;
  if (extension != ".xml") return false;
  try {
    return is_mjcf(read_input_file(file.string(), urdf_max_bytes));
  } catch (const InputError&) {
    return false;
  }
}

RobotDescription read_robot_description(const std::filesystem::path& file, const UrdfOptions& options,
                                        std::vector<InputProblem>* warnings) {
  if (file.extension() == ".xml") return read_mjcf(file.string(), options, warnings);
  RobotDescription robot;
  robot.urdf = file.extension() == ".xacro" ? expanded_xacro(file) : read_input_file(file.string(), urdf_max_bytes);
  robot.model = read_urdf_text(robot.urdf, file.string(), options, warnings);
  return robot;
}

}  // namespace kadans
