// SPDX-License-Identifier: GPL-3.0-or-later

#include "Liggghts.H"

#include <algorithm>
#include <cmath>

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "fix_property_atom.h"
#include "force.h"
#include "input.h"
#include "integrate.h"
#include "lammps.h"
#include "modify.h"
#include "neigh_list.h"
#include "pair.h"
#include "timer.h"
#include "update.h"

bedFoam::Liggghts::Liggghts(
    const std::string& deck, const std::vector<std::pair<std::string, std::string>>& variables
)
{
    std::vector<std::string> words{"bedFoam", "-log", "none"};
    for (const auto& variable : variables)
    {
        words.insert(words.end(), {"-var", variable.first, variable.second});
    }
    std::vector<char*> arguments;
    for (std::string& text : words) arguments.push_back(&text[0]);

    dem_.reset(new LAMMPS_NS::LAMMPS(static_cast<int>(arguments.size()), arguments.data(), MPI_COMM_WORLD));
    dem_->input->file(deck.c_str());
    // bedFoam counts the particles itself, and says where one was lost
    command("thermo_modify lost ignore");

    const auto property = [this](const char* name, bool needed = true)
    {
        return static_cast<LAMMPS_NS::FixPropertyAtom*>(
            dem_->modify->find_fix_property(name, "property/atom", "vector", 0, 0, "bedFoam", needed)
        );
    };
    force_ = property("dragforce");
    dragged_ = property("draggedVelocity");
    lastForce_ = property("lastForce");
    lastTorque_ = property("lastTorque");
    // Kept by the walls' option store_force
    bottom_ = property("force_bottom");
    sides_ = {property("force_left"), property("force_right")};
    // Only where the bed is several particles thick
    for (const char* name : {"force_front", "force_back"})
    {
        if (LAMMPS_NS::FixPropertyAtom* wall = property(name, false)) sides_.push_back(wall);
    }
}

bedFoam::Liggghts::~Liggghts() = default;

void bedFoam::Liggghts::start(long steps)
{
    LAMMPS_NS::Update& update = *dem_->update;
    update.whichflag = 1;
    update.nsteps = static_cast<int>(steps);
    update.firststep = update.beginstep = update.ntimestep;
    update.laststep = update.endstep = update.firststep + steps;
    dem_->init();
    if (!dem_->force->pair || !dem_->force->pair->list)
    {
        dem_->error->all(FLERR, "the deck has no pair_style: it must include liggghts_inputs/include/bed.in");
    }
    update.integrate->setup();
    putBackForces();
    dem_->timer->init();
    dem_->timer->barrier_start(TIME_LOOP);
}

void bedFoam::Liggghts::putBackForces()
{
    for (int i = 0; i < count(); ++i)
    {
        const double* force = lastForce_->array_atom[i];
        // Zero where the restart keeps none, as of a settled bed: under weight no force is exactly zero
        if (force[0] == 0 && force[1] == 0 && force[2] == 0) continue;
        std::copy_n(force, 3, dem_->atom->f[i]);
        std::copy_n(lastTorque_->array_atom[i], 3, dem_->atom->torque[i]);
    }
}

void bedFoam::Liggghts::writeRestart(const std::string& file)
{
    for (int i = 0; i < count(); ++i)
    {
        std::copy_n(dem_->atom->f[i], 3, lastForce_->array_atom[i]);
        std::copy_n(dem_->atom->torque[i], 3, lastTorque_->array_atom[i]);
    }
    command("write_restart " + file);
}

void bedFoam::Liggghts::advance(int steps) { dem_->update->integrate->run(steps); }

void bedFoam::Liggghts::command(const std::string& line) { dem_->input->one(line.c_str()); }

int bedFoam::Liggghts::count() const { return dem_->atom->nlocal; }

long bedFoam::Liggghts::id(int particle) const { return dem_->atom->tag[particle]; }

const double* const* bedFoam::Liggghts::position() const { return dem_->atom->x; }

const double* const* bedFoam::Liggghts::velocity() const { return dem_->atom->v; }

double* const* bedFoam::Liggghts::force() { return force_->array_atom; }

const double* const* bedFoam::Liggghts::draggedVelocity() const { return dragged_->array_atom; }

double* const* bedFoam::Liggghts::draggedVelocity() { return dragged_->array_atom; }

double bedFoam::Liggghts::floorForce() const
{
    double sum = 0;
    for (int i = 0; i < count(); ++i) sum += bottom_->array_atom[i][2];
    return sum;
}

double bedFoam::Liggghts::sideForce() const
{
    double sum = 0;
    for (int i = 0; i < count(); ++i)
    {
        double onParticle = 0;
        for (const LAMMPS_NS::FixPropertyAtom* wall : sides_) onParticle += wall->array_atom[i][2];
        sum += onParticle;
    }
    return sum;
}

void bedFoam::Liggghts::deepestPair(Overlap& deepest) const
{
    const LAMMPS_NS::NeighList& list = *dem_->force->pair->list;
    double** x = dem_->atom->x;
    const double* radius = dem_->atom->radius;
    for (int n = 0; n < list.inum; ++n)
    {
        const int i = list.ilist[n];
        for (int m = 0; m < list.numneigh[i]; ++m)
        {
            const int j = list.firstneigh[i][m] & NEIGHMASK;
            const double dx = x[i][0] - x[j][0], dy = x[i][1] - x[j][1], dz = x[i][2] - x[j][2];
            const double reach = radius[i] + radius[j];
            // The root only for a pair that is deeper than the deepest so far
            const double apart = reach * (1 - deepest.depth);
            const double squared = dx * dx + dy * dy + dz * dz;
            if (squared < apart * apart)
            {
                deepest = {
                    1 - std::sqrt(squared) / reach,
                    {x[i][0], x[i][1], x[i][2]},
                    id(i),
                    "particle " + std::to_string(id(j))
                };
            }
        }
    }
}

void bedFoam::Liggghts::deepestAt(const Plane& wall, Overlap& deepest) const
{
    double** x = dem_->atom->x;
    const double* radius = dem_->atom->radius;
    for (int i = 0; i < count(); ++i)
    {
        const double depth = 0.5 - wall.inward * (x[i][wall.axis] - wall.position) / (2 * radius[i]);
        if (depth > deepest.depth)
            deepest = {depth, {x[i][0], x[i][1], x[i][2]}, id(i), "the wall " + wall.name};
    }
}

bool bedFoam::Liggghts::hasFix(const std::string& name) const
{
    return dem_->modify->find_fix(name.c_str()) >= 0;
}

bedFoam::Overlap bedFoam::Liggghts::deepestOverlap(const std::vector<Plane>& walls) const
{
    Overlap deepest;
    deepestPair(deepest);
    for (const Plane& wall : walls) deepestAt(wall, deepest);
    return deepest;
}

std::pair<double, double> bedFoam::Liggghts::slab() const
{
    return {dem_->domain->sublo[0], dem_->domain->subhi[0]};
}
