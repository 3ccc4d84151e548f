mod kinematics;
mod regularity;
