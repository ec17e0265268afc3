// SPDX-License-Identifier: GPL-3.0-or-later
// Prints the drag force on a particle by each law: name, voidage, superficial slip [m/s], force [N].

#include <cstdio>

#include "dragLaws.H"

int main()
{
    const double voidages[] = {0.4, 0.5, 0.7, 0.79999, 0.80001, 0.9, 0.999};
    const double slips[] = {0, 1e-6, 0.5, 1.5, 20};
    for (const std::string& name : bedFoam::dragLawNames())
    {
        for (const double voidage : voidages)
            for (const double slip : slips)
            {
                const bedFoam::DragState state{voidage, 1e-3, slip / voidage, 1.2, 1.8e-5};
                const double coefficient = bedFoam::dragLaw(name)(state);
                const double force = coefficient * state.slip;
                std::printf("%s %.5f %g %.9e %.9e\n", name.c_str(), voidage, slip, coefficient, force);
            }
    }
}
