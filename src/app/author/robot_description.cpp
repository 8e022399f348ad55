#include "robot_description.h"

#include <optional>
#include <system_error>

#include "kadans/signal/input_error.h"
#include "kadans/signal/shell_word.h"
#include "model/urdf/xacro_values.h"
#include "model/xml_scan.h"
#include "realtime/machine/child_process.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::size_t urdf_max_bytes = std::size_t{16} << 20U;

std::string expanded_xacro(const std::filesystem::path& file) {
  check_input_file(file);
  const auto fail = [&](const std::string& message) { refuse(file, message); };
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
  if (extension == ".urdf" || extension == ".URDF" || extension == ".mjcf") return true;
  if (extension != ".xml") return false;
  try {
    return is_mjcf(read_input_file(file.string(), urdf_max_bytes));
  } catch (const InputError&) {
    return false;
  }
}

UrdfPackages packages_of(const std::vector<std::string>& options) {
  UrdfPackages packages;
  for (const std::string& package : options) {
    const std::size_t end = package.find('=');
    if (end == 0 || end == std::string::npos || !std::filesystem::is_directory(package.substr(end + 1)))
      refuse("--package " + package, "must be NAME=FOLDER, with a folder that is there");
    packages[package.substr(0, end)] = package.substr(end + 1);
  }
  return packages;
}

RobotDescription read_robot_description(const std::filesystem::path& file, const UrdfOptions& options,
                                        std::vector<InputProblem>* warnings) {
  RobotDescription robot;
  const bool is_xacro = file.extension() == ".xacro";
  robot.urdf = is_xacro ? expanded_xacro(file) : read_input_file(file.string(), urdf_max_bytes);
  const std::string_view root = is_xacro ? "robot" : first_element(robot.urdf);
  if (root == "mujoco" || (root != "robot" && file.extension() == ".xml"))
    return read_mjcf(file.string(), options, warnings);
  std::optional<XacroValues> values;
  if (!is_xacro) values = with_xacro_values(robot.urdf, file.string());
  if (values) robot.urdf = values->text;
  if (!is_xacro && !values && robot.urdf.find("<xacro:") != std::string::npos) {
    try {
      robot.urdf = expanded_xacro(file);
    } catch (const InputError&) {  // the program is not there, or knows no better: the reader tells the places
    }
  }
  robot.model = read_urdf_text(robot.urdf, file.string(), options, warnings);
  if (values && options.strict) throw InputError(values->told);
  if (values && warnings != nullptr) warnings->insert(warnings->begin(), values->told);
  return robot;
}

}  // namespace kadans
