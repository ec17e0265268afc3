// SPDX-License-Identifier: GPL-3.0-or-later

#include "dragLaws.H"

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double smallReynolds = 1e-12; // keeps powers of Re finite for a particle that moves with the gas

//- Reynolds number with the superficial slip [1]
double reynolds(const bedFoam::DragState& s)
{
    return std::max(s.density * s.voidage * s.slip * s.diameter / s.viscosity, smallReynolds);
}

//- Stokes' coefficient 3 pi mu d [kg/s]
double stokes(const bedFoam::DragState& s) { return 3 * pi * s.viscosity * s.diameter; }

double ergun(const bedFoam::DragState& s)
{
    const double solids = 1 - s.voidage;
    const double perVolume = 150 * solids * s.viscosity / (s.voidage * s.diameter * s.diameter)
        + 1.75 * s.density * s.slip / s.diameter;
    return pi / 6 * s.diameter * s.diameter * s.diameter * perVolume;
}

const std::vector<std::pair<std::string, bedFoam::DragLaw>> laws{
    {"gidaspow", bedFoam::gidaspow}, {"gidaspow_blend", bedFoam::gidaspowBlend},
    {"wen_yu", bedFoam::wenYu},      {"di_felice", bedFoam::diFelice},
    {"beetstra", bedFoam::beetstra}, {"koch_hill", bedFoam::kochHill},
};

}

double bedFoam::gidaspow(const DragState& s)
{
    constexpr double ergunBelow = 0.8;
    return s.voidage < ergunBelow ? ergun(s) : wenYu(s);
}

double bedFoam::gidaspowBlend(const DragState& s)
{
    constexpr double steepness = 150 * 1.75;
    const double dilute = 0.5 + std::atan(steepness * (s.voidage - 0.8)) / pi;
    return dilute * wenYu(s) + (1 - dilute) * ergun(s);
}

double bedFoam::wenYu(const DragState& s)
{
    const double re = reynolds(s);
    // 24/Re times Stokes' share, in a form that stays finite at rest
    const double overStokes = re < 1000 ? 1 + 0.15 * std::pow(re, 0.687) : 0.44 * re / 24;
    return stokes(s) * overStokes * std::pow(s.voidage, -2.65);
}

double bedFoam::diFelice(const DragState& s)
{
    const double re = reynolds(s);
    const double coefficient = std::pow(0.63 + 4.8 / std::sqrt(re), 2);
    const double exponent = 3.7 - 0.65 * std::exp(-0.5 * std::pow(1.5 - std::log10(re), 2));
    return stokes(s) * coefficient * re / 24 * s.voidage * std::pow(s.voidage, -exponent);
}

double bedFoam::beetstra(const DragState& s)
{
    const double re = reynolds(s);
    const double e = s.voidage;
    const double solids = 1 - e;
    const double viscous = 10 * solids / (e * e) + e * e * (1 + 1.5 * std::sqrt(solids));
    const double inertial = 0.413 * re / (24 * e * e) * (1 / e + 3 * e * solids + 8.4 * std::pow(re, -0.343))
        / (1 + std::pow(10, 3 * solids) * std::pow(re, -0.5 * (1 + 4 * solids)));
    return stokes(s) * e * (viscous + inertial);
}

double bedFoam::kochHill(const DragState& s)
{
    const double solids = 1 - s.voidage;
    const double f0 = solids < 0.4
        ? (1 + 3 * std::sqrt(solids / 2) + 135.0 / 64 * solids * std::log(std::max(solids, 1e-300))
           + 16.14 * solids)
            / (1 + 0.681 * solids - 8.48 * solids * solids + 8.16 * std::pow(solids, 3))
        : 10 * solids / std::pow(s.voidage, 3);
    const double f3 = 0.0673 + 0.212 * solids + 0.0232 / std::pow(s.voidage, 5);
    return stokes(s) * s.voidage * s.voidage * (f0 + 0.5 * f3 * reynolds(s));
}

bedFoam::DragLaw bedFoam::dragLaw(const std::string& name)
{
    for (const auto& law : laws)
    {
        if (law.first == name) return law.second;
    }
    return nullptr;
}

std::vector<std::string> bedFoam::dragLawNames()
{
    std::vector<std::string> names;
    for (const auto& law : laws) names.push_back(law.first);
    return names;
}
