"""The scene `hang` in MuJoCo: a square sheet that falls from level and swings on two corners.

One metre square, 0.2 kg/m2, 1000 N/m, Poisson's ratio 0.3, bending 1e-5 N m, 25 frames a second for
two seconds. Prints `figure cpu_s` (CPU seconds per simulated second, stepping alone) and a line
`figure centre TIME_S Y_M Z_M` for every frame: the mean of the vertices; the sheet is pinned at y = 0.

    pip install -r benches/peers/requirements.txt
    python benches/peers/mujoco_hang.py VERTICES_A_SIDE STEP_S
"""

import sys
import time

import mujoco
import numpy as np

DENSITY, MODULUS, POISSON, BENDING, GRAVITY = 0.2, 1000.0, 0.3, 1e-5, 9.81
FRAME_RATE, FRAMES = 25, 50


def model(n, step_s):
    side = np.linspace(0, 1, n)
    x, y = np.meshgrid(side - 0.5, side)
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], 1)
    j, i = np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij")
    a = (j * n + i).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])
    # A shell of this thickness has the stiffness of the sheet in its plane and against bending.
    thickness = float(np.sqrt(12 * (1 - POISSON**2) * BENDING / MODULUS))
    text = lambda numbers: " ".join(f"{v:.9g}" for v in numbers.ravel())
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><size memory="8G"/>
        <option timestep="{step_s:.9g}" gravity="0 0 -{GRAVITY}" integrator="discrete" solver="CG"
          iterations="100" tolerance="1e-8"/>
        <worldbody>
          <flexcomp name="c" type="direct" dim="2" radius="0.003" mass="{DENSITY}"
            point="{text(points)}" element="{text(faces)}">
            <elasticity young="{MODULUS / thickness}" poisson="{POISSON}" thickness="{thickness}"
              elastic2d="both" damping="0"/>
            <contact selfcollide="none" contype="0" conaffinity="0"/>
            <pin id="0 {n - 1}"/>
          </flexcomp>
        </worldbody></mujoco>"""
    )


def main():
    n, step_s = int(sys.argv[1]), float(sys.argv[2])
    substeps = max(1, round(1 / FRAME_RATE / step_s))
    sheet = model(n, 1 / FRAME_RATE / substeps)
    data = mujoco.MjData(sheet)
    mujoco.mj_forward(sheet, data)
    cpu_s = 0.0
    for frame in range(FRAMES + 1):
        _, y, z = data.flexvert_xpos.mean(0)
        print(f"figure centre {frame / FRAME_RATE:.2f} {y:.6f} {z:.6f}")
        start = time.process_time()
        for _ in range(substeps if frame < FRAMES else 0):
            mujoco.mj_step(sheet, data)
        cpu_s += time.process_time() - start
    print(f"figure cpu_s {cpu_s * FRAME_RATE / FRAMES:.4f}")


if __name__ == "__main__":
    main()
