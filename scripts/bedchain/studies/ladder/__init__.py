# SPDX-License-Identifier: GPL-3.0-or-later
"""The ladder of models: what each says of one bed, at what cost and with what error."""
