// The other baseline of live.py: the job of textbook_node.py, in C++ as the tutorials teach it.
//
// One actuator, nothing but good input, rclcpp::spin; the queues are as long as those of
// gear_state_publisher.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <geometry_msgs/msg/pose.hpp>
#include <geometry_msgs/msg/pose_array.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>

using geometry_msgs::msg::Pose;
using geometry_msgs::msg::PoseArray;
using sensor_msgs::msg::JointState;

namespace
{
constexpr double PI = 3.141592653589793;
constexpr double ECCENTRICITY = 0.0011;  // m
constexpr double GEAR_RATIO = -19.0;
constexpr std::pair<double, double> BRANCHES[] = {{0.0, 0.04}, {PI, -0.04}};  // cam phase, z (m)
constexpr size_t DEPTH = 2000;

Pose body(double x, double y, double z, double output_angle)
{
  Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.position.z = z;
  const double half = 0.5 * std::remainder(output_angle, 2.0 * PI);
  pose.orientation.z = std::sin(half);
  pose.orientation.w = std::cos(half);
  return pose;
}
}  // namespace

class RclcppNode : public rclcpp::Node
{
public:
  RclcppNode()
  : Node("rclcpp_node"),
    output_state_(create_publisher<JointState>("output_state", DEPTH)),
    body_poses_(create_publisher<PoseArray>("body_poses", DEPTH)),
    rotor_state_(create_subscription<JointState>(
        "rotor_state", DEPTH, [this](const JointState & rotor) {on_rotor_state(rotor);}))
  {
  }

private:
  void on_rotor_state(const JointState & rotor)
  {
    const auto name = std::find(rotor.name.begin(), rotor.name.end(), "rotor");
    const auto index = name - rotor.name.begin();
    const double rotor_angle = rotor.position[index];
    const double output_angle = rotor_angle / GEAR_RATIO;  // eq. (5)

    JointState state;
    state.header.stamp = rotor.header.stamp;
    state.name = {"output_shaft"};
    state.position = {output_angle};
    state.velocity = {rotor.velocity[index] / GEAR_RATIO};
    state.effort = {rotor.effort[index] * GEAR_RATIO};
    output_state_->publish(state);

    PoseArray poses;
    poses.header.stamp = rotor.header.stamp;
    poses.header.frame_id = "stator";
    for (const auto & [cam_phase, z] : BRANCHES) {  // satellites: eqs. (9) and (10)
      const double theta = rotor_angle + cam_phase;
      poses.poses.push_back(
        body(-ECCENTRICITY * std::sin(theta), ECCENTRICITY * std::cos(theta), z, output_angle));
    }
    for (const auto & [cam_phase, z] : BRANCHES) {  // Oldham couplings: eqs. (20) to (22)
      const double slide = ECCENTRICITY * std::cos(rotor_angle + cam_phase - output_angle);
      poses.poses.push_back(
        body(-slide * std::sin(output_angle), slide * std::cos(output_angle), z, output_angle));
    }
    body_poses_->publish(poses);
  }

  rclcpp::Publisher<JointState>::SharedPtr output_state_;
  rclcpp::Publisher<PoseArray>::SharedPtr body_poses_;
  rclcpp::Subscription<JointState>::SharedPtr rotor_state_;
};

int main(int argc, char * argv[])
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<RclcppNode>());
  rclcpp::shutdown();
}
