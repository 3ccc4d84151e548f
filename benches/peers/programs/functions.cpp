/* Pinocchio's functions over numbers: `functions FUNCTION TREE.txt`.
 *
 * A row is q, v and a, as in Pinocchio. Timed is the function with the copies of a row in and of its results out:
 *
 *     inverse_dynamics               rnea: n numbers
 *     inverse_dynamics_derivatives   computeRNEADerivatives: n rows of dtau/dq and dtau/dv
 *     acceleration_derivatives       computeABADerivatives for torques of 0: n rows of dv/dt and its derivatives by q, v and torques */
#include "common.h"
#include "tree.hpp"

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <cstring>

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
typedef Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> Rows;

struct Context {
    const Tree &tree;
    pinocchio::Data data;
    VectorXd q, v, a, torque;
    MatrixXd by_q, by_v, by_a;
    int count, width;
    const double *states;
    std::vector<double> results;
};

void read(Context &c, int i) {
    const int nq = c.tree.model.nq, nv = c.tree.model.nv;
    const double *state = c.states + i * (nq + 2 * nv);
    c.q = VectorXd::Map(state, nq);
    c.v = VectorXd::Map(state + nq, nv);
    c.a = VectorXd::Map(state + nq + nv, nv);
}

void inverse_dynamics(void *context) {
    Context &c = *static_cast<Context *>(context);
    for (int i = 0; i < c.count; i++) {
        read(c, i);
        VectorXd::Map(c.results.data() + i * c.width, c.width) = pinocchio::rnea(c.tree.model, c.data, c.q, c.v, c.a);
    }
}

void inverse_dynamics_derivatives(void *context) {
    Context &c = *static_cast<Context *>(context);
    const int nv = c.tree.model.nv;
    for (int i = 0; i < c.count; i++) {
        read(c, i);
        c.by_q.setZero(), c.by_v.setZero(), c.by_a.setZero();
        pinocchio::computeRNEADerivatives(c.tree.model, c.data, c.q, c.v, c.a, c.by_q, c.by_v, c.by_a);
        Eigen::Map<Rows> rows(c.results.data() + i * c.width, nv, 2 * nv);
        rows.leftCols(nv) = c.by_q;
        rows.rightCols(nv) = c.by_v;
    }
}

void acceleration_derivatives(void *context) {
    Context &c = *static_cast<Context *>(context);
    const int nv = c.tree.model.nv;
    for (int i = 0; i < c.count; i++) {
        read(c, i);
        c.by_q.setZero(), c.by_v.setZero(), c.by_a.setZero();
        pinocchio::computeABADerivatives(c.tree.model, c.data, c.q, c.v, c.torque, c.by_q, c.by_v, c.by_a);
        Eigen::Map<Rows> rows(c.results.data() + i * c.width, nv, 3 * nv + 1);
        rows.col(0) = c.data.ddq;
        rows.middleCols(1, nv) = c.by_q;
        rows.middleCols(1 + nv, nv) = c.by_v;
        // of the inverse of the mass matrix Pinocchio writes the upper triangle
        rows.rightCols(nv) = c.by_a.selfadjointView<Eigen::Upper>();
    }
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) stop("functions FUNCTION TREE.txt");
    const Tree tree = read_tree(argv[2]);
    const int nq = tree.model.nq, nv = tree.model.nv;
    int count;
    const double *states = read_states(&count, nq + 2 * nv);
    const MatrixXd none = MatrixXd::Zero(nv, nv);
    const VectorXd zero = VectorXd::Zero(nv);
    Context c{tree, pinocchio::Data(tree.model), VectorXd(nq), zero, zero, zero, none, none, none, count, 0, states, {}};
    void (*pass)(void *) = nullptr;
    if (!strcmp(argv[1], "inverse_dynamics")) pass = inverse_dynamics, c.width = nv;
    if (!strcmp(argv[1], "inverse_dynamics_derivatives")) pass = inverse_dynamics_derivatives, c.width = 2 * nv * nv;
    if (!strcmp(argv[1], "acceleration_derivatives")) pass = acceleration_derivatives, c.width = nv * (3 * nv + 1);
    if (!pass) stop("inverse_dynamics, inverse_dynamics_derivatives or acceleration_derivatives?");
    c.results.resize(size_t(count) * size_t(c.width));
    print_batches(count, pass, &c);
    for (int i = 0; i < count; i++) print_row(c.results.data() + i * c.width, c.width);
}
