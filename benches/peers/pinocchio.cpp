// Pinocchio's constraintDynamics without Python in between: `python -m bench` compiles and runs this against the
// headers and libraries of the PyPI packages `pin` and `cmeel-eigen`.
//
// Arguments: the model as `pin.Model.saveToText` writes it, and a file with the closures (joint, joint of the
// platform, point on the platform) and the states (q, v, tau). Every line of the input asks for so many rounds over
// all states and is answered with seconds a call; the first line of the output has the accelerations at all states.

#include <chrono>
#include <fstream>
#include <iostream>
#include <vector>

#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/serialization.hpp>

namespace pin = pinocchio;

struct State {
  Eigen::VectorXd q, v, tau;
};

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  pin::Model model;
  model.loadFromText(argv[1]);
  pin::Data data(model);

  std::ifstream file(argv[2]);
  std::size_t closure_count, state_count;
  file >> closure_count >> state_count;
  pin::RigidConstraintModelVector closures;
  pin::RigidConstraintDataVector closure_data;
  for (std::size_t i = 0; i < closure_count; ++i) {
    pin::JointIndex limb, plate;
    Eigen::Vector3d point;
    file >> limb >> plate >> point.x() >> point.y() >> point.z();
    closures.emplace_back(pin::CONTACT_3D, model, limb, pin::SE3::Identity(), plate,
                          pin::SE3(Eigen::Matrix3d::Identity(), point), pin::LOCAL);
    closure_data.emplace_back(closures.back());
  }
  std::vector<State> states(state_count);
  for (State& state : states) {
    state = {Eigen::VectorXd(model.nq), Eigen::VectorXd(model.nv), Eigen::VectorXd(model.nv)};
    for (Eigen::VectorXd* vector : {&state.q, &state.v, &state.tau})
      for (double& x : *vector) file >> x;
  }
  if (!file) return 3;

  pin::ProximalSettings proximal(1e-14, 0.0, 1);
  pin::initConstraintDynamics(model, data, closures, closure_data);
  const auto accelerate = [&](const State& state) -> const Eigen::VectorXd& {
    return pin::constraintDynamics(model, data, state.q, state.v, state.tau, closures, closure_data, proximal);
  };

  std::cout.precision(17);
  for (const State& state : states) std::cout << accelerate(state).transpose() << ' ';
  std::cout << std::endl;
  double sink = 0.0;
  for (long rounds; std::cin >> rounds;) {
    const auto begin = std::chrono::steady_clock::now();
    for (long i = 0; i < rounds; ++i)
      for (const State& state : states) sink += accelerate(state)[0];
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    std::cout << elapsed.count() / double(rounds * states.size()) << std::endl;
  }
  return sink == 0.5;  // keeps the calls
}
