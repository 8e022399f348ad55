#!/usr/bin/env python3
"""Writes torso_motion.csv: what an IMU in the torso of a squatting, swaying, tilting robot would measure, and the truth.

Place and angles of the torso are given as smooth functions of time. Everything else follows from them by derivation
(central differences of 0.1 ms): the gyro measures the body rates, the accelerometer the specific force R^T (p'' + g).
Bias and white noise of a small MEMS unit are added. Only the standard library is used; the numbers are the same in
every run:  python3 make_torso_motion.py > torso_motion.csv
"""
import math
import random

RATE_HZ, DURATION_S, G = 100, 25.0, 9.81
GYRO_BIAS, GYRO_NOISE = (0.010, -0.008, 0.005), 0.005  # rad/s
ACC_BIAS, ACC_NOISE = (0.03, -0.02, 0.05), 0.05  # m/s^2


def bump(t, middle, width):
    return math.exp(-(((t - middle) / width) ** 2) / 2)


def begin(t):  # the robot stands still for a second
    return 1 / (1 + math.exp(-8 * (t - 1.5)))


def place(t):
    x = 0.02 * math.sin(2 * math.pi * 0.4 * t) * begin(t)
    y = 0.03 * math.sin(2 * math.pi * 0.7 * t) * begin(t)
    z = -0.05 * (1 - math.cos(2 * math.pi * (t - 1.5) / 5.0)) * begin(t)
    for middle in (9.0, 9.6, 10.2, 10.8, 18.0):  # stamps
        z += 0.0025 * bump(t, middle, 0.015)
    return x, y, z


def angles(t):  # roll, pitch, yaw
    roll = 0.04 * math.sin(2 * math.pi * 0.7 * t + 0.4) * begin(t) + 0.5 * bump(t, 20.0, 0.5)
    pitch = 0.12 * math.sin(2 * math.pi * t / 5.0) * begin(t) + 0.7 * bump(t, 14.0, 0.6)
    yaw = 0.25 * math.sin(2 * math.pi * 0.15 * t) * begin(t)
    return roll, pitch, yaw


def rotation(t):  # Rz(yaw) Ry(pitch) Rx(roll), rows
    (sr, sp, sy), (cr, cp, cy) = [[f(a) for a in angles(t)] for f in (math.sin, math.cos)]
    return ((cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            (-sp, cp * sr, cp * cr))


def measure(t, h=1e-4):
    r, r1, r0 = rotation(t), rotation(t + h), rotation(t - h)
    rate = [[sum(r[k][i] * (r1[k][j] - r0[k][j]) for k in range(3)) / (2 * h) for j in range(3)] for i in range(3)]
    gyro = (rate[2][1], rate[0][2], rate[1][0])  # R^T R' is the rate's cross product matrix
    p, p1, p0 = place(t), place(t + h), place(t - h)
    force = [(p1[k] - 2 * p[k] + p0[k]) / h**2 for k in range(3)]
    force[2] += G
    return gyro, [sum(r[k][i] * force[k] for k in range(3)) for i in range(3)]


noise = random.Random(14)
print("# An IMU in the torso of a squatting, swaying, stamping and tilting robot, 100 Hz, and the torso's true angles.")
print("# Made by make_torso_motion.py, from a motion given in closed form; see there. Bias and noise are in the readings:")
print(f"# gyro bias {GYRO_BIAS} noise {GYRO_NOISE} rad/s; accelerometer bias {ACC_BIAS} noise {ACC_NOISE} m/s^2.")
print("gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,acc_x_m_s2,acc_y_m_s2,acc_z_m_s2,roll_rad,pitch_rad,yaw_rad")
for n in range(int(RATE_HZ * DURATION_S)):
    gyro, acc = measure(n / RATE_HZ)
    row = [g + b + noise.gauss(0, GYRO_NOISE) for g, b in zip(gyro, GYRO_BIAS)]
    row += [a + b + noise.gauss(0, ACC_NOISE) for a, b in zip(acc, ACC_BIAS)]
    print(",".join(f"{value:.4f}" for value in [*row, *angles(n / RATE_HZ)]))
