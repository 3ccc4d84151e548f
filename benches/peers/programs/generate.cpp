/* Pinocchio's algorithms over CasADi's symbols, shared by cse and written as C: `generate TREE.txt NAME.c [rate | FUNCTION]`.
 *
 * accelerations(q, v) -> dv/dt, by the articulated-body algorithm; with `rate`, of a free tree in space, also rate(x) -> dx/dt for
 * x = (q, v). With the name of a function, as in functions.cpp, it is function(q, v, a) -> its results by rows instead. NAME.c is written to
 * the working directory. */
#include <casadi/casadi.hpp>
#include <pinocchio/autodiff/casadi.hpp>

#include "tree.hpp"

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <cstring>

using casadi::Slice;
using casadi::SX;

typedef Eigen::Matrix<SX, Eigen::Dynamic, 1> Vector;

namespace {

Vector eigen(const SX &symbols) {
    Vector result(symbols.size1());
    for (casadi_int i = 0; i < symbols.size1(); i++) result[i] = symbols(i);
    return result;
}

/* dq/dt: R V of the reference joint, and half of each quaternion (x, y, z, w) times its angular velocity. */
SX coordinate_rates(const Tree &tree, const SX &q, const SX &v) {
    std::vector<SX> rates;
    for (size_t j = 0; j < tree.quaternions.size(); j++) {
        const casadi_int at = tree.quaternions[j];
        const SX p = q(Slice(at, at + 3)), w = q(at + 3);
        if (j == 0) {
            const SX linear = v(Slice(0, 3)), twice = 2 * cross(p, linear);
            rates.push_back(linear + w * twice + cross(p, twice));
        }
        const SX spin = v(Slice(tree.rates[j], tree.rates[j] + 3)) / 2;
        rates.push_back(w * spin + cross(p, spin));
        rates.push_back(-dot(p, spin));
    }
    return vertcat(rates);
}

typedef Eigen::Matrix<SX, Eigen::Dynamic, Eigen::Dynamic> Matrix;

SX casadi_of(const Matrix &matrix) {
    SX result(matrix.rows(), matrix.cols());
    for (int i = 0; i < matrix.rows(); i++)
        for (int j = 0; j < matrix.cols(); j++) result(i, j) = matrix(i, j);
    return result;
}

/* The results of a function of functions.cpp. */
SX results(const std::string &name, const pinocchio::ModelTpl<SX> &model, const Vector &q, const Vector &v, const Vector &a) {
    pinocchio::DataTpl<SX> data(model);
    const int nv = model.nv;
    const Matrix none = Matrix::Constant(nv, nv, SX(0));
    Matrix by_q = none, by_v = none, by_a = none;
    if (name == "inverse_dynamics") return casadi_of(pinocchio::rnea(model, data, q, v, a));
    if (name == "inverse_dynamics_derivatives") {
        pinocchio::computeRNEADerivatives(model, data, q, v, a, by_q, by_v, by_a);
        return horzcat(casadi_of(by_q), casadi_of(by_v));
    }
    if (name != "acceleration_derivatives") stop("there is no such function");
    const Vector torque = Vector::Constant(nv, SX(0));
    pinocchio::computeABADerivatives(model, data, q, v, torque, by_q, by_v, by_a);
    const SX inverse = triu2symm(triu(casadi_of(by_a)));
    return horzcat(casadi_of(data.ddq), casadi_of(by_q), casadi_of(by_v), inverse);
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 3) stop("TREE.txt NAME.c [rate | FUNCTION]");
    const Tree tree = read_tree(argv[1]);
    const pinocchio::ModelTpl<SX> model = tree.model.cast<SX>();
    pinocchio::DataTpl<SX> data(model);
    const SX q = SX::sym("q", model.nq), v = SX::sym("v", model.nv);
    if (argc > 3 && strcmp(argv[3], "rate")) {
        const SX a = SX::sym("a", model.nv);
        const SX rows = vec(results(argv[3], model, eigen(q), eigen(v), eigen(a)).T());
        const casadi::Function function("function", {q, v, a}, {cse(densify(rows))});
        casadi::CodeGenerator code(argv[2], {{"casadi_int", "long long int"}});
        code.add(function);
        code.generate();
        printf("{\"operations\": %lld, \"nq\": %d, \"nv\": %d, \"width\": %lld}\n", (long long)function.n_instructions(), model.nq, model.nv, (long long)rows.size1());
        return 0;
    }
    Vector torque(model.nv);
    for (int i = 0; i < model.nv; i++) torque[i] = 0.0;
    pinocchio::aba(model, data, eigen(q), eigen(v), torque);
    SX a(model.nv, 1);
    for (int i = 0; i < model.nv; i++) a(i) = data.ddq[i];
    casadi::CodeGenerator code(argv[2], {{"casadi_int", "long long int"}});
    const casadi::Function accelerations("accelerations", {q, v}, {cse(a)});
    code.add(accelerations);
    if (argc > 3 && !strcmp(argv[3], "rate"))
        code.add(casadi::Function("rate", {vertcat(q, v)}, {cse(vertcat(coordinate_rates(tree, q, v), a))}));
    code.generate();
    printf("{\"operations\": %lld, \"nq\": %d, \"nv\": %d, \"quaternions\": [", (long long)accelerations.n_instructions(), model.nq, model.nv);
    for (size_t j = 0; j < tree.quaternions.size(); j++) printf("%s%d", j ? ", " : "", tree.quaternions[j]);
    printf("]}\n");
    return 0;
}
