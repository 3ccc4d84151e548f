/* Pinocchio's articulated-body algorithm: `aba accelerations TREE.txt` and `aba fall TREE.txt DURATION STEP`.
 *
 * A state is q then v, as in Pinocchio. Timed is pinocchio::aba with the copies of a state in and of its accelerations out; the fall is by the classical
 * Runge-Kutta method of order 4 over (q, v), quaternions being made unit ones after each step. */
#include "common.h"
#include "tree.hpp"

#include <pinocchio/algorithm/aba.hpp>

#include <cstring>

namespace {

using Eigen::VectorXd;

struct Context {
    const Tree &tree;
    pinocchio::Data data;
    VectorXd q, v, torque;
    int count, steps;
    double step;
    const double *states;
    std::vector<double> results;
};

void pass(void *context) {
    Context &c = *static_cast<Context *>(context);
    const int nq = c.tree.model.nq, nv = c.tree.model.nv;
    for (int i = 0; i < c.count; i++) {
        const double *state = c.states + i * (nq + nv);
        c.q = VectorXd::Map(state, nq);
        c.v = VectorXd::Map(state + nq, nv);
        VectorXd::Map(c.results.data() + i * nv, nv) = pinocchio::aba(c.tree.model, c.data, c.q, c.v, c.torque);
    }
}

/* dx/dt of x = (q, v). */
void evaluate(Context &c, const VectorXd &x, VectorXd &slope) {
    const pinocchio::Model &model = c.tree.model;
    c.q = x.head(model.nq);
    c.v = x.tail(model.nv);
    slope.tail(model.nv) = pinocchio::aba(model, c.data, c.q, c.v, c.torque);
    for (size_t j = 0; j < c.tree.quaternions.size(); j++) {
        const Eigen::Map<const Eigen::Quaterniond> orientation(c.q.data() + c.tree.quaternions[j]);
        const Vector3d w = c.v.segment<3>(c.tree.rates[j]);
        const Eigen::Quaterniond spin(0, w.x() / 2, w.y() / 2, w.z() / 2);
        slope.segment<4>(c.tree.quaternions[j]) = (orientation * spin).coeffs();
        if (j == 0) slope.head<3>() = orientation.toRotationMatrix() * c.v.head<3>();
    }
}

void fall(void *context) {
    Context &c = *static_cast<Context *>(context);
    const int width = c.tree.model.nq + c.tree.model.nv;
    const double h = c.step;
    VectorXd x = VectorXd::Map(c.states, width), y(width), k1(width), k2(width), k3(width), k4(width);
    for (int step = 0; step < c.steps; step++) {
        evaluate(c, x, k1);
        y = x + h / 2 * k1;
        evaluate(c, y, k2);
        y = x + h / 2 * k2;
        evaluate(c, y, k3);
        y = x + h * k3;
        evaluate(c, y, k4);
        x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        for (int quaternion : c.tree.quaternions) x.segment<4>(quaternion).normalize();
    }
    VectorXd::Map(c.results.data(), width) = x;
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 3) stop("accelerations TREE.txt, or fall TREE.txt DURATION STEP");
    const Tree tree = read_tree(argv[2]);
    const int nq = tree.model.nq, nv = tree.model.nv;
    int count;
    const double *states = read_states(&count, nq + nv);
    Context c{tree, pinocchio::Data(tree.model), VectorXd(nq), VectorXd(nv), VectorXd::Zero(nv), count, 0, 0.0, states, {}};
    c.results.resize(size_t(count * (nq + nv)));
    if (!strcmp(argv[1], "accelerations")) {
        print_batches(count, pass, &c);
        for (int i = 0; i < count; i++) print_row(c.results.data() + i * nv, nv);
    } else if (!strcmp(argv[1], "fall") && argc == 5 && tree.free && !tree.plane) {
        c.step = atof(argv[4]);
        c.steps = int(atof(argv[3]) / c.step + 0.5);
        print_runs(fall, &c);
        print_row(c.results.data(), nq + nv);
    } else {
        stop("accelerations, or fall of a free tree in space?");
    }
}
