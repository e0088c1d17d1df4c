// What Python and the experiments page say to one another: written by `python -m app.protocol`.

/** @typedef {"IDLE" | "RUNNING" | "STOPPED" | "FINISHED" | "FAILED"} CampaignPhase */
/** @typedef {"HOLDS" | "FAILS" | "OPEN"} ClaimVerdict */
/** @typedef {{name: string, chosen: boolean}} Offer Something that can be chosen. */
/** @typedef {{name: string, done: number, total: number}} CampaignPart How far a part of a campaign is. */
/** @typedef {{name: string, mean: number}} CurveLevel What a preset collects. */

/**
 * What can be compared, and what is chosen, as it was typed.
 * @typedef {object} ChoiceMessage
 * @property {"choice"} type
 * @property {Offer[]} rules
 * @property {Offer[]} scenarios
 * @property {string} table Name of the rules in the table.
 * @property {string} arena Name of the scenario of the arena.
 * @property {string} against
 * @property {boolean | number | string} runs
 * @property {boolean | number | string} seed
 * @property {Object<string, string>} findings What is wrong, by name.
 */

/**
 * The newest comparison as far as it is made.
 * @typedef {object} ComparedMessage
 * @property {"compared"} type
 * @property {boolean} busy
 * @property {number} share Of all the work that is done.
 * @property {string} error
 * @property {number} runs
 * @property {number} seed
 * @property {string} against
 * @property {string} explanation
 * @property {ScenarioResults[]} scenarios
 */

/**
 * The next campaign, as it was typed.
 * @typedef {object} DraftMessage
 * @property {"draft"} type
 * @property {Object<string, boolean | number | string>} values
 * @property {Object<string, string>} findings
 * @property {Offer[]} sizes
 * @property {?number} seconds How long it will take; null if that cannot be told.
 */

/**
 * The present or last campaign.
 * @typedef {object} CampaignStatusMessage
 * @property {"status"} type
 * @property {CampaignPhase} phase
 * @property {?string} name
 * @property {number} share
 * @property {string} doing
 * @property {?number} seconds_left
 * @property {string} error
 */

/**
 * All campaigns that are kept, and which of them is looked at.
 * @typedef {object} CampaignsMessage
 * @property {"campaigns"} type
 * @property {?string} shown
 * @property {KeptCampaign[]} campaigns
 */

/**
 * The campaign looked at; without a name there is none.
 * @typedef {object} CampaignMessage
 * @property {"campaign"} type
 * @property {?string} name
 * @property {string} problem
 * @property {number} share
 * @property {boolean} reported
 * @property {CampaignPart[]} parts
 * @property {SeedCurve[]} curves
 * @property {CurveLevel[]} levels
 * @property {JudgedClaim[]} claims
 */

/**
 * All rule sets in a scenario.
 * @typedef {object} ScenarioResults
 * @property {string} name
 * @property {string} objective What the figures are of.
 * @property {boolean} maximise More is better.
 * @property {CaseResult[]} results
 */

/**
 * A campaign that is kept.
 * @typedef {object} KeptCampaign
 * @property {string} name
 * @property {string} problem
 * @property {?PlannedCampaign} plan
 * @property {boolean} reported
 * @property {number} written Seconds since 1970.
 */

/**
 * The best so far of an evolution, only where it rises.
 * @typedef {object} SeedCurve
 * @property {string} name
 * @property {number[]} generation
 * @property {number[]} best_so_far
 */

/**
 * A claim of the paper.
 * @typedef {object} JudgedClaim
 * @property {string} where
 * @property {string} paper
 * @property {string} found
 * @property {ClaimVerdict} verdict
 * @property {string} words
 */

/**
 * A rule set in a scenario.
 * @typedef {object} CaseResult
 * @property {string} rules
 * @property {string} scenario
 * @property {number[]} fitness Of every run.
 * @property {number} mean
 * @property {number} sd
 * @property {number} median
 * @property {?number} p_value
 * @property {?number} p_holm
 * @property {?number} effect
 */

/**
 * How large a campaign is.
 * @typedef {object} PlannedCampaign
 * @property {number} runs
 * @property {number} generations
 * @property {number} evaluations
 * @property {number} seed
 */

/** Messages to Python. */
export const request = {
  /**
   * Compare a rule set, or in a scenario, or no longer.
   *
   * @param {"rules" | "scenarios"} what
   * @param {string} name
   * @param {boolean} on
   */
  choose: (what, name, on) => ({ type: "choose", what, name, on }),
  /**
   * `against`, `runs` or `seed` of the comparison was typed.
   *
   * @param {"against" | "runs" | "seed"} name
   * @param {boolean | number | string} value
   */
  choice: (name, value) => ({ type: "choice", name, value }),
  /** A rule set from a file is offered from now on. @param {string} name @param {string} text */
  file: (name, text) => ({ type: "file", name, text }),
  /** Begin the comparison. */
  compare: () => ({ type: "compare" }),
  /** Do not go on with it. */
  cancel: () => ({ type: "cancel" }),
  /** Fill the next campaign. @param {string} name */
  size: (name) => ({ type: "size", name }),
  /** A value of the next campaign was typed. @param {string} name @param {boolean | number | string} value */
  draft: (name, value) => ({ type: "draft", name, value }),
  /** Begin the next campaign. */
  start: () => ({ type: "start" }),
  /** Stop the campaign under way. */
  stop: () => ({ type: "stop" }),
  /** Go on with a campaign. @param {string} name */
  resume: (name) => ({ type: "resume", name }),
  /** Look at a campaign. @param {string} name */
  open: (name) => ({ type: "open", name }),
};
