# SPDX-License-Identifier: GPL-3.0-or-later
# The physics of the scene by dimensionless numbers, of a bed of particles or of two fluids.
AUDITED = ["bed", "particles", "contact", "gas", "drum", "mixing"]


# First of all that can run: what it warns of is read before the particles have taken hours.
rule audit_scene:
    input:
        code("audit_scene"),
    output:
        table=f"{RESULTS}/audit.csv",
    log:
        f"{LOGS}/audit_scene.log",
    priority: 1
    conda:
        "../envs/python.yaml"
    params:
        case={section: CASE[section] for section in AUDITED if section in CASE},
    script:
        "audit_scene.py"
