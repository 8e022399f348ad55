#include "mjcf.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace kadans::bench {
namespace {

constexpr int digits = 17;

class Writer {
 public:
  Writer(const RobotModel& model, const PlantSettings& settings) : model_(model), settings_(settings) {
    out_ << std::setprecision(digits);
  }

  std::string write(const MjcfOptions& options) {
    out_ << "<mujoco><compiler angle=\"radian\" autolimits=\"false\"/><option timestep=\"" << options.time_step_s
         << "\" solver=\"" << options.solver << "\" integrator=\"" << options.integrator
         << "\"/><size njmax=\"2000\" nconmax=\"500\"/>\n";
    hulls();
    out_ << "<worldbody>\n"
         << "<geom type=\"plane\" size=\"0 0 1\" contype=\"0\" conaffinity=\"1\" friction=\"0.8 0.005 0.0001\"/>\n";
    link(0);
    for (const WorldObject& object : settings_.world.objects) ball(object);
    out_ << "</worldbody><actuator>\n";
    for (const Joint& joint : model_.joints) out_ << "<motor joint=\"" << joint.name << "\"/>\n";
    out_ << "</actuator></mujoco>\n";
    return out_.str();
  }

 private:
  template <typename Values>
  void numbers(const char* name, const Values& values) {
    out_ << ' ' << name << "=\"";
    for (const double value : values) out_ << value << ' ';
    out_ << '"';
  }

  static std::string hull_name(std::size_t link, std::size_t geometry) {
    return "hull" + std::to_string(link) + "_" + std::to_string(geometry);
  }

  void hulls() {
    out_ << "<asset>\n";
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      for (std::size_t j = 0; j < model_.links[i].collisions.size(); ++j) {
        const auto* const mesh = std::get_if<Mesh>(&model_.links[i].collisions[j].shape);
        if (mesh == nullptr || mesh->corners_m.empty()) continue;
        std::vector<double> all;
        for (const Vec3& corner : mesh->corners_m) all.insert(all.end(), corner.begin(), corner.end());
        out_ << "<mesh name=\"" << hull_name(i, j) << '"';
        numbers("vertex", all);
        out_ << "/>\n";
      }
    }
    out_ << "</asset>\n";
  }

  void link(std::size_t index) {
    const Link& link = model_.links[index];
    const Pose pose = index == 0 ? settings_.base : model_.joints[index - 1].origin;
    out_ << "<body name=\"" << link.name << '"';
    numbers("pos", pose.position_m);
    numbers("quat", pose.orientation);
    out_ << ">\n";
    if (index == 0) out_ << "<freejoint/>\n";
    if (index > 0) joint(index - 1);
    const Inertia& i = link.inertia;
    out_ << "<inertial mass=\"" << i.mass_kg << '"';
    numbers("pos", i.com_m);
    numbers("fullinertia", std::array{i.xx, i.yy, i.zz, i.xy, i.xz, i.yz});
    out_ << "/>\n";
    for (std::size_t j = 0; j < link.collisions.size(); ++j) geom(link.collisions[j], hull_name(index, j));
    for (std::size_t child = 0; child < model_.joints.size(); ++child) {
      if (model_.joints[child].parent == index) this->link(child + 1);
    }
    out_ << "</body>\n";
  }

  void joint(std::size_t index) {
    const Joint& joint = model_.joints[index];
    const DriveSettings& drive = settings_.drives[index];
    out_ << "<joint type=\"hinge\" name=\"" << joint.name << "\" limited=\""
         << (std::isfinite(joint.lower_rad) ? "true" : "false") << '"';
    numbers("axis", joint.axis);
    if (std::isfinite(joint.lower_rad)) numbers("range", std::array{joint.lower_rad, joint.upper_rad});
    numbers("armature", std::array{drive.rotor_inertia_kg_m2});
    numbers("damping", std::array{drive.viscous_Nms_per_rad + drive.parallel_damping_Nms_per_rad});
    numbers("stiffness", std::array{drive.parallel_spring_Nm_per_rad});
    numbers("springref", std::array{drive.parallel_rest_rad});
    out_ << "/>\n";
  }

  void geom(const Geometry& geometry, const std::string& hull) {
    const auto* const mesh = std::get_if<Mesh>(&geometry.shape);
    if (mesh != nullptr && mesh->corners_m.empty()) return;
    out_ << "<geom contype=\"1\" conaffinity=\"2\" friction=\"0.8 0.005 0.0001\"";
    numbers("pos", geometry.pose.position_m);
    numbers("quat", geometry.pose.orientation);
    if (const auto* box = std::get_if<Box>(&geometry.shape)) {
      out_ << " type=\"box\"";
      numbers("size", std::array{box->size_m[0] / 2, box->size_m[1] / 2, box->size_m[2] / 2});
    } else if (const auto* sphere = std::get_if<Sphere>(&geometry.shape)) {
      out_ << " type=\"sphere\"";
      numbers("size", std::array{sphere->radius_m});
    } else if (const auto* cylinder = std::get_if<Cylinder>(&geometry.shape)) {
      out_ << " type=\"cylinder\"";
      numbers("size", std::array{cylinder->radius_m, cylinder->length_m / 2});
    } else {
      out_ << " type=\"mesh\" mesh=\"" << hull << '"';
    }
    out_ << "/>\n";
  }

  void ball(const WorldObject& object) {
    const auto& ball = std::get<WorldBall>(object.shape);
    out_ << "<body";
    numbers("pos", object.pose.position_m);
    out_ << "><freejoint/><geom type=\"sphere\" contype=\"3\" conaffinity=\"1\" friction=\"0.8 0.005 0.0001\"";
    numbers("size", std::array{ball.radius_m});
    numbers("mass", std::array{ball.mass_kg});
    out_ << "/></body>\n";
  }

  const RobotModel& model_;
  const PlantSettings& settings_;
  std::ostringstream out_;
};

}  // namespace

std::string mjcf(const RobotModel& model, const PlantSettings& settings, const MjcfOptions& options) {
  return Writer(model, settings).write(options);
}

}  // namespace kadans::bench
