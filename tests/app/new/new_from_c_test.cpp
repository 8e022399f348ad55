// `kadans new control-object --from-c`: what it reads in the tables of code in the shapes of three tools, and what it
// refuses. Whether what it writes builds and runs a robot, the outside project tests (tests/project/outside.sh).
#include <map>

#include <doctest/doctest.h>

#include "app/program.h"

namespace kadans::program::new_from_c_test {
namespace {

const std::filesystem::path examples = std::filesystem::path(KADANS_SOURCE_DIR) / "tests/app/generated_code";

Outcome wrap(const std::filesystem::path& code, const std::filesystem::path& where, const std::string& more = "") {
  return run("new control-object made --from-c '" + code.string() + "'" + more, where);
}

struct OddCode {
  const char* name;
  const char* from;  // an example; "": none
  const char* file;
  const char* text;  // in place of `with`; "": the file is deleted
  const char* with;
  const char* says;
};

}  // namespace

TEST_CASE("Code of a 20-sim submodel has its names from tables in a comment, and no main program") {
  const auto folder = fresh_folder("from_twenty_sim");
  const Outcome made = wrap(examples / "twenty_sim", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "20-sim: 4 inputs, 2 outputs, 5 parameters; a step every 0.002 s"));
  const std::string source = read(folder / "made/made.cpp"), calls = read(folder / "made/made_code.c");
  CHECK(has(source, "{\"tilt.measured\", \"\", -1e6, 1e6, \"Input tilt.measured.\"}"));
  CHECK(has(calls, "xx_P[3] = parameters[3];"));
  CHECK(has(calls, "XXCalculateSubmodel(u, y, time_s);"));
  CHECK(std::filesystem::exists(folder / "made/code/xxfuncs.c"));
  CHECK(!std::filesystem::exists(folder / "made/code/xxmain.c"));
  CHECK(has(read(folder / "made/CMakeLists.txt"), "\"code/xxmodel.c\" \"code/xxsubmod.c\""));
  CHECK(!has(source + calls + read(folder / "made/made.h") + read(folder / "made/CMakeLists.txt"), "@"));
}

TEST_CASE("Code of a 20-sim submodel without tables has its names from the comments beside u and y") {
  const auto folder = fresh_folder("from_twenty_sim_comments");
  std::filesystem::create_directories(folder / "code");
  write(folder / "code/xxsubmod.h",
        "double XXInitializeSubmodelpan (XXDouble *u, XXDouble *y, XXDouble t);\n"
        "double XXCalculateSubmodelpan (XXDouble *u, XXDouble *y, XXDouble t);\n"
        "double XXTerminateSubmodelpan (XXDouble *u, XXDouble *y, XXDouble t);\n");
  write(folder / "code/xxsubmod.c",
        "u[0] = 0.0;\t\t/* in */\nu[1] = 0.0; /* position */\ny[0] = 0.0; /* corr */\ny[1] = xx_V[2];\t/* out */\n");
  const Outcome without = wrap(folder / "code", folder);
  CHECK(without.exit_code == 2);
  CHECK(has(without.err, "does not say how often a step of it is taken: looked for xx_step_size"));
  const Outcome made = wrap(folder / "code", folder, " --period 0.01");
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "\"in\": \"...\", \"position\": \"...\", \"corr\": \"...\", \"out\": \"...\""));
  CHECK(has(read(folder / "made/made_code.c"), "XXCalculateSubmodelpan(u, y, time_s);"));
}

TEST_CASE("Code of Simulink Coder has its names from its structs, arrays by element") {
  const auto folder = fresh_folder("from_simulink");
  const Outcome made = wrap(examples / "simulink", folder, " --plugin");
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "Simulink Coder: 7 inputs, 3 outputs, 5 parameters; a step every 0.001 s"));
  const std::string calls = read(folder / "made/made_code.c");
  CHECK(has(calls, "jiwiy_pid_U.enabled = inputs[6];"));
  CHECK(has(calls, "outputs[2] = jiwiy_pid_Y.error;"));
  CHECK(has(calls, "jiwiy_pid_P.Kd[1] = parameters[4];"));
  CHECK(has(read(folder / "made/plugin.cpp"), "plugin_type<make_made>(\"made\")"));
}

TEST_CASE("Sources of an FMU have names, units and sentences from modelDescription.xml, and step as they are told") {
  const auto folder = fresh_folder("from_fmu");
  const Outcome made = wrap(examples / "openmodelica", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "OpenModelica (FMI 2.0): 2 inputs, 1 outputs, 2 parameters; a step every tick"));
  CHECK(has(read(folder / "made/made.cpp"), "{\"controller.k\", \"Nm/rad\", -1e6, 1e6, \"Torque per error.\"}"));
  const std::string calls = read(folder / "made/made_code.c");
  CHECK(has(calls, "input_references[] = {1u, 2u};"));
  CHECK(has(calls, "parameter_references[] = {4u, 5u, 0};"));
  CHECK(has(calls, "Servo_fmi2DoStep(code, time_s, step_s, 1);"));
}

TEST_CASE("Texts of modelDescription.xml are decoded, and what stands in its comments is no variable") {
  const auto folder = fresh_folder("from_fmu_texts");
  std::filesystem::copy(examples / "openmodelica", folder / "code", std::filesystem::copy_options::recursive);
  const auto description = folder / "code/modelDescription.xml";
  REQUIRE(edit(description, "<Real unit=\"Nm\"/></ScalarVariable>",
               "<Real unit=\"&#176;\"/></ScalarVariable>\n<!-- <ScalarVariable name=\"old\" valueReference=\"9\" "
               "causality=\"output\"><Real/></ScalarVariable> -->"));
  REQUIRE(edit(description, "Torque per error.", "Torque &quot;per&quot; error."));
  const Outcome made = wrap(folder / "code", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "2 inputs, 1 outputs, 2 parameters"));
  const std::string source = read(folder / "made/made.cpp");
  CHECK(has(source, "{\"torque\", \"\u00b0\", -1e6, 1e6, \"Output torque.\"}"));
  CHECK(has(source, "\"Torque \\\"per\\\" error.\"}"));
}

TEST_CASE("Files of XML beside code of C may hold anything, and what is too much for a description is refused") {
  const auto folder = fresh_folder("from_c_beside_xml");
  std::filesystem::copy(examples / "twenty_sim", folder / "code", std::filesystem::copy_options::recursive);
  write(folder / "code/data.xml",
        "<d>" + std::string(200'000, 'x') + " xx_input_names [2] = { \"no\" } u[0]; /* no */</d>\n");
  const Outcome made = wrap(folder / "code", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(has(made.err, "4 inputs, 2 outputs, 5 parameters"));
  write(folder / "code/modelDescription.xml", "<fmiModelDescription>" + std::string(3U << 20U, ' '));
  CHECK(has(wrap(folder / "code", folder).err, "modelDescription.xml: has more than 2097152 bytes"));
  write(folder / "code/modelDescription.xml", std::string("<fmiModelDescription/>\0<x/>", 27));
  CHECK(has(wrap(folder / "code", folder).err, "modelDescription.xml: is no XML: "));
}

TEST_CASE("Code that fits no shape is refused with the file, what was looked for and what was found") {
  const OddCode table[] = {
      {"none", "", "law.c", "", "double law(double e) { return 2 * e; }\n",
       "looked for XXInitializeSubmodel in a header (20-sim), `extern void MODEL_step(void);` in a header (Simulink "
       "Coder), and modelDescription.xml with sources (OpenModelica, FMI 2.0); found law.c"},
      {"empty", "", "readme.txt", "", "nothing\n", "found no file of C"},
      {"half", "twenty_sim", "xxsubmod.h", "void XXTerminateSubmodel (XXDouble *u, XXDouble *y, XXDouble t);", "",
       "xxsubmod.h: looked for XXTerminateSubmodel (XXDouble *u, XXDouble *y, XXDouble t), found none"},
      {"arguments", "twenty_sim", "xxsubmod.h", "XXCalculateSubmodel (XXDouble *u, XXDouble *y, XXDouble t)",
       "XXCalculateSubmodel (void)", "found XXCalculateSubmodel (void)"},
      {"nameless", "twenty_sim", "xxmodel.c", "xx_input_names", "xx_in",
       "looked for the names of its inputs: a table xx_input_names, or `u[0] = 0.0; /* name */`; found neither in"},
      {"reusable", "simulink", "jiwiy_pid.h", "extern void jiwiy_pid_step(void)", "extern void jiwiy_pid_step(RT *m)",
       "jiwiy_pid.h: looked for jiwiy_pid_step(void), found jiwiy_pid_step(RT *m): generate it with nonreusable code"},
      {"bus", "simulink", "jiwiy_pid.h", "real_T error; ", "Bus error; ",
       "looked for numbers in ExtY_jiwiy_pid_T, found the field error of the type Bus"},
      {"structless", "simulink", "jiwiy_pid.h", "} ExtU_jiwiy_pid_T;", "} Other;",
       "declares jiwiy_pid_U of the type ExtU_jiwiy_pid_T: looked for its struct, found none in"},
      {"version", "openmodelica", "modelDescription.xml", "fmiVersion=\"2.0\"", "fmiVersion=\"1.0\"",
       "modelDescription.xml: looked for fmiVersion=\"2.0\", found \"1.0\""},
      {"torn", "openmodelica", "modelDescription.xml", "<ModelStructure/>", "<ModelStructure>", "not well-formed XML"},
      {"exchange", "openmodelica", "modelDescription.xml",
       "<CoSimulation modelIdentifier=\"Servo\" canHandleVariableCommunicationStepSize=\"true\">\n"
       "    <SourceFiles><File name=\"Servo_FMU.c\"/></SourceFiles>\n  </CoSimulation>",
       "<ModelExchange modelIdentifier=\"Servo\"/>", "looked for <CoSimulation modelIdentifier=...>, found none"},
      {"binary", "openmodelica", "sources/Servo_FMU.c", "NAMED(fmi2DoStep)", "NAMED(step)",
       "looked for fmi2DoStep in sources of C beside it, found none in modelDescription.xml, Servo_FMU.c"},
      {"flag", "openmodelica", "modelDescription.xml", "<Real unit=\"Nm\"/>", "<Boolean/>",
       "looked for Real outputs, found 'torque' of another type"},
  };
  const auto folder = fresh_folder("from_c_refused");
  for (const OddCode& odd : table) {
    CAPTURE(odd.name);
    const auto code = folder / odd.name;
    if (*odd.from == 0) {
      std::filesystem::create_directories(code);
      write(code / odd.file, odd.with);
    } else {
      std::filesystem::copy(examples / odd.from, code, std::filesystem::copy_options::recursive);
      REQUIRE(edit(code / odd.file, odd.text, odd.with));
    }
    const Outcome refused = wrap(code, folder);
    CHECK(refused.exit_code == 2);
    CHECK_MESSAGE(has(refused.err, odd.says), refused.err);
    CHECK(!std::filesystem::exists(folder / "made"));
  }
  CHECK(has(wrap(folder / "nowhere", folder).err, "nowhere: is no folder"));
  CHECK(has(run("new control-object made --period 0.01", folder).err, "--period: is that of C code"));
}

}  // namespace kadans::program::new_from_c_test
