/**
 * The messages between the page and Python, as types. Rules and individuals count from 0.
 *
 * @typedef {"IDLE" | "RUNNING" | "PAUSED" | "STOPPED" | "FINISHED" | "FAILED"} Phase
 * @typedef {{name: string, changed: string[]}} Preset The nearest one, and where settings differ.
 *
 * @typedef {object} Field
 * @property {string} name
 * @property {"whole" | "number" | "choice" | "switch"} kind
 * @property {string[]} choices
 * @property {string} help
 * @property {boolean} steerable
 *
 * @typedef {object} FormMessage
 * @property {"form"} type
 * @property {string[]} presets
 * @property {number} most_compared
 * @property {Field[]} fields
 *
 * @typedef {object} PlanMessage The next run, as it was typed.
 * @property {"plan"} type
 * @property {string} preset
 * @property {Object<string, number | string | boolean>} values
 * @property {string[]} changed Fields that differ from the preset.
 * @property {string[]} idle Fields that have no effect beside the others.
 * @property {Object<string, string>} findings What is wrong, by field.
 * @property {number | string} seed
 * @property {boolean} from_table
 * @property {string} scenario
 * @property {string} table Name of the rules in the table.
 * @property {{text: string, frozen: boolean, enabled: boolean}[]} rules
 * @property {boolean} moved The frozen rules are not the first ones.
 *
 * @typedef {object} About
 * @property {string} scenario
 * @property {Preset} preset
 * @property {number} seed
 * @property {number} frozen How many rules.
 * @property {number} generations
 * @property {number} done
 * @property {boolean} finished
 * @property {?number} best
 * @property {?number} mean
 *
 * @typedef {object} StatusMessage
 * @property {"status"} type
 * @property {Phase} phase
 * @property {boolean} active
 * @property {string} error
 * @property {?string} run The present or last one.
 * @property {boolean} resumable
 * @property {number} done
 * @property {number} generations
 * @property {?string} shown The run looked at.
 * @property {string} problem Why it cannot be looked at.
 * @property {?About} about
 * @property {Object<string, number>} settings What can be steered; nothing unless a run is open.
 * @property {string[]} idle
 *
 * @typedef {object} CurvesMessage
 * @property {"curves"} type
 * @property {?string} run
 * @property {number[]} generation
 * @property {number[]} best_so_far
 * @property {number[]} best
 * @property {number[]} mean
 * @property {{name: string, mean: number}[]} references
 * @property {{generation: number, text: string, fitness: ?number}[]} marks
 *
 * @typedef {{name: string, generation: number[], best_so_far: number[]}} OtherCurve
 * @typedef {{type: "compared", runs: OtherCurve[]}} ComparedMessage
 *
 * @typedef {{low: number, high: number, mean: number, counts: number[]}} Histogram
 * @typedef {[number, number, number, number, number, ?number, ?number]} Member
 *   Generation, key, fitness, evaluations, codons, rules, number of the behaviour.
 *
 * @typedef {object} PopulationMessage
 * @property {"population"} type
 * @property {number} generation
 * @property {number} size
 * @property {number} invalid
 * @property {number} behaviours
 * @property {number} diversity
 * @property {[number, number][]} common Behaviours that most have, and how many have them.
 * @property {Histogram} fitness
 * @property {Histogram} codons
 * @property {Member[]} members The best first.
 *
 * @typedef {[number, number, number, [number, number][]]} Ancestor
 *   Generation, key, fitness, births of the parents.
 * @typedef {[number, number, number, string, number]} Step
 *   Generation, key, fitness, how it was bred, codons.
 * @typedef {{type: "ancestors", all: Ancestor[], line: Step[]}} AncestorsMessage
 *
 * @typedef {object} Run
 * @property {string} name
 * @property {string} problem
 * @property {string} scenario
 * @property {?Preset} preset
 * @property {?number} seed
 * @property {number} done
 * @property {?number} generations
 * @property {?number} best
 * @property {Phase} phase
 * @property {number} written Seconds since 1970.
 *
 * @typedef {{type: "runs", compared: string[], runs: Run[]}} RunsMessage
 *
 * @typedef {object} ChosenMessage
 * @property {"chosen"} type
 * @property {?{run: string, generation: number, key: number, fitness: number}} individual
 * @property {{text: string, english: string}[]} rules
 *
 * @typedef {{type: "notice", level: "error" | "info", text: string}} NoticeMessage
 */

export {};
