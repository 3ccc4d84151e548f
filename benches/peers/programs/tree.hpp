/* A tree as Pinocchio's model, from a text: "plane free elements" and gravity, then for each element its parent (-1 for none), at,
 * mass, cg, inertia; SI units. Or a robot: "robot joints" and gravity, then for each joint its parent (0 is the universe), its kind (free, hinge or
 * slider), axis, placement (a rotation by rows, a translation), mass, cg, and inertia (xx, xy, yy, xz, yz, zz). */
#ifndef TREE_HPP
#define TREE_HPP

#include "common.h"

#include <pinocchio/multibody.hpp>

#include <fstream>
#include <string>
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

/* The joint of a kind and an axis, as Pinocchio's own readers choose it. */
inline pinocchio::JointModel joint_model(const std::string &kind, const Vector3d &axis) {
    if (kind == "free") return pinocchio::JointModelFreeFlyer();
    if (kind == "hinge") {
        if (axis == Vector3d::UnitX()) return pinocchio::JointModelRX();
        if (axis == Vector3d::UnitY()) return pinocchio::JointModelRY();
        if (axis == Vector3d::UnitZ()) return pinocchio::JointModelRZ();
        return pinocchio::JointModelRevoluteUnaligned(axis);
    }
    if (kind != "slider") stop("a robot has joints that are free, hinges or sliders");
    if (axis == Vector3d::UnitX()) return pinocchio::JointModelPX();
    if (axis == Vector3d::UnitY()) return pinocchio::JointModelPY();
    if (axis == Vector3d::UnitZ()) return pinocchio::JointModelPZ();
    return pinocchio::JointModelPrismaticUnaligned(axis);
}

inline Tree read_robot(std::istream &text) {
    Tree tree{{}, false, false, {}, {}};
    int count;
    text >> count;
    tree.model.gravity.linear(vector(text));
    for (int i = 0; i < count; i++) {
        size_t parent;
        std::string kind;
        double mass, xx, xy, yy, xz, yz, zz;
        text >> parent >> kind;
        const Vector3d axis = vector(text);
        Eigen::Matrix3d rotation;
        for (int row = 0; row < 3; row++) rotation.row(row) = vector(text);
        const Vector3d at = vector(text);
        text >> mass;
        const Vector3d cg = vector(text);
        text >> xx >> xy >> yy >> xz >> yz >> zz;
        Eigen::Matrix3d inertia;
        inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        const pinocchio::SE3 placement(rotation, at);
        const auto joint = tree.model.addJoint(parent, joint_model(kind, axis), placement, std::to_string(i));
        tree.model.appendBodyToJoint(joint, pinocchio::Inertia(mass, cg, inertia), pinocchio::SE3::Identity());
    }
    if (!text) stop("the robot cannot be read");
    return tree;
}

inline Tree read_tree(const char *path) {
    std::ifstream text(path);
    std::string word;
    if (text >> word && word == "robot") return read_robot(text);
    text.seekg(0);
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
