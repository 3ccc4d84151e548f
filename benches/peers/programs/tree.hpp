/* A tree as Pinocchio's model, from a text: "plane free elements" and gravity, then for each element its parent (-1 for none), at,
 * mass, cg, inertia; SI units. */
#ifndef TREE_HPP
#define TREE_HPP

#include "common.h"

#include <pinocchio/multibody.hpp>

#include <fstream>
#include <vector>

namespace {

using Eigen::Vector3d;

struct Tree {
    pinocchio::Model model;
    bool plane, free;
    /* Where the quaternion and the angular velocity of each element begin in q and v. */
    std::vector<int> quaternions, rates;
};

inline Vector3d vector(std::istream &text) {
    Vector3d v;
    text >> v.x() >> v.y() >> v.z();
    return v;
}

inline Tree read_tree(const char *path) {
    std::ifstream text(path);
    Tree tree;
    int count;
    text >> tree.plane >> tree.free >> count;
    tree.model.gravity.linear(vector(text));
    std::vector<pinocchio::JointIndex> joints;
    for (int i = 0; i < count; i++) {
        int parent;
        double mass;
        text >> parent;
        const Vector3d at = vector(text);
        text >> mass;
        const Vector3d cg = vector(text), inertia = vector(text);
        pinocchio::JointIndex on = parent < 0 ? 0 : joints[size_t(parent)];
        pinocchio::SE3 placement(Eigen::Matrix3d::Identity(), at);
        const bool root = parent < 0 && tree.free;
        const std::string name = std::to_string(i);
        if (tree.plane && root) {
            on = tree.model.addJoint(on, pinocchio::JointModelPX(), placement, name + "x");
            on = tree.model.addJoint(on, pinocchio::JointModelPZ(), pinocchio::SE3::Identity(), name + "z");
            placement = pinocchio::SE3::Identity();
        }
        if (tree.plane) {
            on = tree.model.addJoint(on, pinocchio::JointModelRY(), placement, name);
        } else {
            const int skip = root ? 3 : 0;
            tree.quaternions.push_back(tree.model.nq + skip);
            tree.rates.push_back(tree.model.nv + skip);
            on = root ? tree.model.addJoint(on, pinocchio::JointModelFreeFlyer(), placement, name)
                      : tree.model.addJoint(on, pinocchio::JointModelSpherical(), placement, name);
        }
        tree.model.appendBodyToJoint(on, pinocchio::Inertia(mass, cg, inertia.asDiagonal().toDenseMatrix()), pinocchio::SE3::Identity());
        joints.push_back(on);
    }
    if (!text) stop("the tree cannot be read");
    return tree;
}

} // namespace

#endif
