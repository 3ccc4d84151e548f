/* Pinocchio's articulated-body algorithm over CasADi's symbols, shared by cse and written as C: `generate TREE.txt NAME.c [rate]`.
 *
 * accelerations(q, v) -> dv/dt; with `rate`, of a free tree in space, also rate(x) -> dx/dt for x = (q, v). NAME.c is written to the
 * working directory. */
#include <casadi/casadi.hpp>
#include <pinocchio/autodiff/casadi.hpp>

#include "tree.hpp"

#include <pinocchio/algorithm/aba.hpp>

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

} // namespace

int main(int argc, char **argv) {
    if (argc < 3) stop("TREE.txt NAME.c [rate]");
    const Tree tree = read_tree(argv[1]);
    const pinocchio::ModelTpl<SX> model = tree.model.cast<SX>();
    pinocchio::DataTpl<SX> data(model);
    const SX q = SX::sym("q", model.nq), v = SX::sym("v", model.nv);
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
