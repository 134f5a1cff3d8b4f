// What the robot really does, beside what was predicted.
import type { JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import type { Path } from '../../shared/board/types';
import { useLegend, WorldName } from '../../shared/play/board_pane';
import { Mark } from '../../shared/play/mark';
import { Brackets, type Bracket } from '../../shared/play/brackets';
import { Compare } from '../../shared/play/compare';
import { Fan, stateAt } from '../../shared/play/fan';
import { sentence, t, type TextKey } from '../../shared/texts';
import { exploreTitle, Exploring } from '../parts/explore';
import { Button, Heading, TimeLeft } from '../parts/ui';
import { remember } from '../memory';
import type { Frame, Judged } from '../protocol';
import type { ScreenProps } from '../screen';
import { keep, recall } from '../storage';
import { useWorld } from '../world';

type Shown = NonNullable<ScreenProps['view']['feedback']>;

// One task per screen.
export function Feedback({ feedback, view, connection, token }: ScreenProps & { feedback: Shown }): JSX.Element {
  const { part = 0, round = 0 } = view.progress ?? {};
  const key = `${part}.${round}`;
  const [index, setIndex] = useState(() => {
    const kept = recall<{ key: string; index: number }>('feedback');
    return kept?.key === key ? Math.min(kept.index, feedback.tests.length - 1) : 0;
  });
  const go = (to: number): void => {
    setIndex(to);
    keep('feedback', { key, index: to });
  };
  const [isExploring, setExploring] = useState(false);
  const test = feedback.tests[index];
  const isLast = index >= feedback.tests.length - 1;
  const off = connection.isPending('continue');
  const next = (
    <div class="submit act-bar">
      {isLast && feedback.all_right && feedback.tests.length > 1 && <p>{t('feedback.all_right')}</p>}
      <Button primary off={off} onClick={() => (isLast ? connection.send('continue', { round }) : go(index + 1))}>
        {t(off ? 'feedback.continuing' : isLast ? 'common.continue' : 'common.next')}
      </Button>
      {isLast && <p class="muted">{t(nextKey(feedback, view.group.size))}</p>}
    </div>
  );
  if (!test) {
    return (
      <>
        <Heading>{t('feedback.title.none')}</Heading>
        {next}
      </>
    );
  }
  return (
    <>
      <p class="kicker">{t('feedback.count', { index: index + 1, of: feedback.tests.length })}</p>
      <TimeLeft until={view.limit_ms} />
      {isLast && view.explore && (
        <div class="buttons tabs">
          <Button pressed={!isExploring} onClick={() => setExploring(false)}>
            {t('feedback.title.none')}
          </Button>
          <Button pressed={isExploring} onClick={() => setExploring(true)}>
            {exploreTitle(view.explore)}
          </Button>
        </div>
      )}
      {isLast && view.explore && isExploring ? (
        <section class="explore-part" aria-label={exploreTitle(view.explore)}>
          <Exploring explore={view.explore} onAsk={(asked) => asked && connection.send('explore', asked)} />
          {next}
        </section>
      ) : (
        <OneTask key={index} test={test} token={token} brackets={isLast ? (feedback.brackets ?? []) : []} next={next} />
      )}
    </>
  );
}

interface OneTaskProps {
  test: Judged;
  token: string;
  brackets: Bracket[];
  next: JSX.Element;
}

function OneTask({ test, token, brackets, next }: OneTaskProps): JSX.Element {
  const { board, right } = test;
  const robot = pathOf(test.robot, test.robot_repeats_from, test.robot_repeats_text);
  const mine = right || !test.mine ? null : pathOf(test.mine, test.mine_repeats_from);
  const legend = useLegend(board.domain);
  const verdict = right ? 'right' : test.mine ? 'wrong' : 'none';
  useLayoutEffect(() => remember(test), []);
  return (
    <>
      <div class={`verdict ${verdict}`}>
        <Mark verdict={verdict} />
        <Heading>{t(`feedback.title.${verdict}`)}</Heading>
      </div>
      {!(test.cost && board.map) && <p class="lead">{t(leadKey(test))}</p>}
      <WorldName board={board} />
      <Compare
        board={board}
        legend={legend}
        robot={robot}
        other={mine}
        otherName={t('ledger.you')}
        otherLine={t('feedback.mine')}
        at={mine ? test.differs_at : null}
        reason={<Reasons test={test} />}
      >
        {test.chance && mine && <Outcomes test={test} chance={test.chance} mine={mine} token={token} />}
        <Brackets brackets={brackets} counted={board.domain.counted} />
        {next}
      </Compare>
    </>
  );
}

interface OutcomesProps {
  test: Judged;
  chance: NonNullable<Judged['chance']>;
  mine: Path;
  token: string;
}

// Where chance has a part: what can follow from the robot's action and from the predicted one where the paths separate.
function Outcomes({ test, chance, mine, token }: OutcomesProps): JSX.Element | null {
  const { world } = useWorld(chance.world, token);
  const legend = useLegend(test.board.domain);
  const at = test.differs_at;
  if (!world || at === null) return null;
  return (
    <Fan
      board={test.board}
      legend={legend}
      world={world}
      state={stateAt(world, chance.state, test.robot, at)}
      own={world.actionOf(test.robot[at])}
      other={world.actionOf(mine.frames[at])}
      isYours
      costs={chance.spared}
    />
  );
}

export const pathOf = (frames: Frame[], from?: number, text?: string): Path => ({
  frames,
  ...(from === undefined ? {} : { repeats_from: from }),
  ...(text === undefined ? {} : { repeats_text: text }),
});

// What follows, to a group or to somebody alone.
function nextKey({ learned, others_unsure }: Shown, size: number): TextKey {
  if (others_unsure) return 'feedback.again_others';
  return `feedback.${learned ? 'learned' : 'again'}${size === 1 ? '_alone' : ''}`;
}

function leadKey({ right, mine, board, differs_at }: Judged): TextKey {
  if (right) return differs_at === null ? 'feedback.right' : 'feedback.right_other';
  if (!mine) return 'feedback.none';
  return board.map ? 'feedback.wrong' : 'feedback.wrong_plain';
}

// The one sentence about this answer; what else follows from the robot's path is there for those who want more. A right
// answer says what it showed.
function Reasons({ test }: { test: Judged }): JSX.Element | null {
  const cost = test.cost ? sentence(test.cost) : test.unfinished && t('feedback.unfinished');
  if (test.why.length === 0 && !cost) return null;
  const all = (
    <ul>
      {test.why.map((text) => (
        <li>{sentence(text)}</li>
      ))}
    </ul>
  );
  return (
    <div class="reasons">
      {test.right && test.why.length > 0 && <p>{t('feedback.showed')}</p>}
      {cost && <p class="cost">{cost}</p>}
      {test.why.length > 0 && cost && (
        <details>
          <summary>{t('feedback.why')}</summary>
          {all}
        </details>
      )}
      {test.why.length > 0 && !cost && all}
    </div>
  );
}
